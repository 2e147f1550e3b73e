"""A report as files: Markdown, self-contained HTML, pictures, and a CSV file behind each table and picture."""

from __future__ import annotations

import base64
import re
from pathlib import Path

import jinja2
from markupsafe import Markup, escape

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.report.figure_style import save_figure
from mrta_zoo.eval.report.parts import Picture, Report, Table
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.text_files import write_text
from mrta_zoo.show.terminal.console import results_console, say

MARKDOWN = re.compile(r"([\\`*_{}\[\]|~$]|^#|^[+-](?=[\s-]|$)|:(?=[\w+-]+:))")
"""What could be markup: at any place, at the beginning of a line, and around the name of an emoji."""
NUMBERED = re.compile(r"^(\d{1,9})([.)])(?=\s|$)")
"""What begins a numbered list."""


def write_report(report: Report, folder: Path) -> None:
    """Write ``report.html``, ``report.md`` and what belongs to them, replacing what was there.

    Raises:
        ConfigError: if a file cannot be written.
    """
    try:
        for section in report.sections:
            for picture in section.pictures:
                save_figure(picture.figure, folder / picture.name)
            parts: list[Picture | Table] = [*section.pictures, *section.tables]
            for part in parts:
                if part.data is not None:
                    text = part.data.to_csv(index=False, lineterminator="\n")
                    write_text(text, folder / f"{part.name}.csv", ConfigError)
        for suffix in ("html", "md"):
            write_text(render(report, suffix, folder), folder / f"report.{suffix}", ConfigError)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be written: {(error.strerror or str(error)).lower()}") from None


def publish(report: Report, folder: Path) -> None:
    """Write the report, and print its summary and where it is.

    Raises:
        ConfigError: if a file cannot be written.
    """
    with Outputs() as outputs:
        outputs.write("report", folder / "report.html", lambda path: write_report(report, path.parent))
        console = results_console()
        for point in report.summary:
            say(console, f"- {point}")
        for line in outputs.written:
            say(console, line)


def render(report: Report, suffix: str, folder: Path) -> str:
    """The report as text.

    Args:
        report: what to say.
        suffix: "html" or "md".
        folder: where its pictures lie, to be embedded in HTML.
    """

    def embedded(name: str) -> str:
        return "data:image/png;base64," + base64.b64encode((folder / f"{name}.png").read_bytes()).decode()

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("mrta_zoo.eval.report"), autoescape=True, undefined=jinja2.StrictUndefined
    )
    environment.filters |= {"embedded": embedded, "md": markdown}
    return environment.get_template(f"report.{suffix}.j2").render(report=report)


def markdown(text: str) -> Markup:
    """Text that Markdown shows as it is: no tags, no emphasis, no cells of a table, one line."""
    line = str(escape(" ".join(str(text).split())))
    return Markup(NUMBERED.sub(r"\1\\\2", MARKDOWN.sub(r"\\\1", line)))
