"""``mrta-zoo reproduce`` from end to end, on a few small cases."""

from __future__ import annotations

import base64
import csv
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest

from mrta_zoo.cli.main import main
from mrta_zoo.eval.report.figure_style import new_figure, style_of
from mrta_zoo.eval.report.files import write_report
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.reproduce import paper
from mrta_zoo.eval.reproduce.methods import reference_of, usual_methods
from mrta_zoo.policies.registry import method_names

METHODS = "random,nearest,capam"
TIMED = ("rows.csv", "sessions.csv", "planning_time.csv")
VOID = ("meta", "img")


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two robots in six cases, three robots in six, 10 tasks each."""
    folder = tmp_path_factory.mktemp("data")
    for robots in (2, 3):
        arguments = ["generate", "--generator", "uniform", "--count", "6", "--tasks", "10", "--robots", str(robots)]
        assert main([*arguments, "--deadline", "30-150", "--format", "csv", "--out", str(folder / f"r{robots}")]) == 0
        for path in (folder / f"r{robots}").iterdir():
            path.rename(path.with_name(f"{robots}{path.name}"))
    return folder


@pytest.fixture(scope="module")
def run(cases: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished report."""
    out = tmp_path_factory.mktemp("run") / "out"
    assert main(arguments(cases, out)) == 0
    return out


def arguments(cases: Path, out: Path, *more: str) -> list[str]:
    usual = {"--cases": f"{cases}/r2,{cases}/r3", "--methods": METHODS, "--out": str(out)}
    return ["reproduce", *(word for flag in usual if flag not in more for word in (flag, usual[flag])), *more]


def lines(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


class Page(HTMLParser):
    """Checks that every tag is closed in order, and collects addresses, cells and text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []
        self.tags: list[str] = []
        self.text: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href", "srcset", "action", "data")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def test_the_report_holds_every_table_and_picture(run: Path) -> None:
    page = Page((run / "report.html").read_text())
    markdown = (run / "report.md").read_text()
    text = " ".join(page.text)
    tables = [path.stem for path in run.glob("*.csv") if path.name not in (*TIMED[:2], "small_rows.csv")]
    pictures = [path.stem for path in run.glob("*.png")]
    assert {"completion_10", "paired_tests_10", "paired_tests_10_by_robots", "all_pairs_10", "share_of_best_10",
            "planning_time", "paper_seconds", "paper_p_values", "paper_completion"} <= set(tables)  # fmt: skip
    assert set(pictures) == {"completion_10", "differences_10"}
    for name in tables:
        assert name in pictures or f"{name}.csv" in text
        assert f"]({name}.csv)" in markdown
    for name in pictures:
        assert f"]({name}.png)" in markdown
        assert (run / f"{name}.svg").read_text().startswith("<?xml")
        assert base64.b64encode((run / f"{name}.png").read_bytes()).decode() in (run / "report.html").read_text()
    assert page.tags.count("table") == len(tables) - 1  # those of the differences are shown apart
    for title in ("Tasks completed", "capam against each other method", "Planning time", "Share of the best known plan",
                  "Optimality gap on small scenarios", "The paper’s numbers", "How this was made"):  # fmt: skip
        assert title in text
        assert title in markdown


def test_the_page_needs_nothing_from_outside(run: Path) -> None:
    page = Page((run / "report.html").read_text())
    assert all(address.startswith(("data:image/png;base64,", "#")) for address in page.addresses)
    assert not {"script", "link", "iframe", "object"} & set(page.tags)
    assert "http" not in (run / "report.html").read_text()
    assert "url(" not in (run / "report.html").read_text()


def test_numbers_are_those_of_the_rows(run: Path) -> None:
    rows = lines(run / "rows.csv")
    assert len(rows) == 12 * 3
    percent = [10 * int(row["completed"]) for row in rows if row["method"] == "capam" and row["robots"] == "2"]
    (cell,) = [line for line in lines(run / "completion_10.csv") if (line["method"], line["robots"]) == ("capam", "2")]
    assert float(cell["mean_percent"]) == pytest.approx(sum(percent) / 6)
    assert int(cell["cases"]) == 6
    both = {(row["method"], row["case"]): 10 * int(row["completed"]) for row in rows}
    differences = [both["capam", case] - both["random", case] for method, case in both if method == "random"]
    (line,) = [line for line in lines(run / "paired_tests_10.csv") if line["second"] == "random"]
    assert float(line["difference"]) == pytest.approx(sum(differences) / 12)
    assert int(line["first_more"]) == sum(each > 0 for each in differences)


def test_resuming_gives_the_same(cases: Path, run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    shutil.copytree(run, out)
    rows = (run / "rows.csv").read_text()
    cut = rows.index("capam") + 40  # within a line of the last method
    (out / "rows.csv").write_text(rows[:cut])
    for path in out.iterdir():
        if path.name not in ("manifest.json", "rows.csv", "sessions.csv", "small_rows.csv"):
            path.unlink()
    assert main(arguments(cases, out)) == 0
    assert {path.name for path in out.iterdir()} == {path.name for path in run.iterdir()}
    for path in run.iterdir():
        if path.suffix in (".csv", ".svg", ".png") and path.name not in TIMED:
            assert path.read_bytes() == (out / path.name).read_bytes(), path.name
    without_seconds = [[{**line, "seconds": ""} for line in lines(folder / "rows.csv")] for folder in (run, out)]
    assert without_seconds[0] == without_seconds[1]
    assert len(lines(out / "sessions.csv")) == 2
    # Again, with nothing left to measure: another reference changes the report, not the rows, and needs no session.
    before = {name: (out / name).read_bytes() for name in ("rows.csv", "sessions.csv", "completion_10.csv")}
    capsys.readouterr()
    assert main(arguments(cases, out, "--against", "nearest")) == 0
    assert "10 tasks, nearest minus each other method" in capsys.readouterr().out
    assert {name: (out / name).read_bytes() for name in before} == before


def test_another_command_is_refused(cases: Path, run: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (run / "rows.csv").read_bytes()
    assert main(arguments(cases, run, "--budget", "1")) == 2
    error = capsys.readouterr().err
    assert "budget was not given, now it is 1.0" in error
    assert error.count("\n") == 1
    assert (run / "rows.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--methods", "nearest,magic"], "there is no method 'magic'"),
        (["--methods", "nearest", "--against", "edf"], "against is 'edf'; expected one of the methods that are run"),
        (["--methods", "nearest", "--cases", "nowhere"], "nowhere does not exist"),
        (["--methods", "nearest", "--threads", "0"], "threads is 0"),
        (["--methods", "nearest", "--budget", "0"], "budget is 0; expected a number of seconds > 0"),
    ],
)
def test_wrong_flags_leave_nothing_behind(
    cases: Path, tmp_path: Path, flags: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(arguments(cases, out, *flags)) == 2
    assert sentence in capsys.readouterr().err
    assert not out.exists()


def test_one_method_on_one_case(cases: Path, tmp_path: Path) -> None:
    (tmp_path / "cases").mkdir()
    shutil.copy(next((cases / "r2").iterdir()), tmp_path / "cases" / "only.csv")
    assert main(["reproduce", "--cases", f"{tmp_path}/cases", "--methods", "edf", "--out", f"{tmp_path}/out"]) == 0
    text = (tmp_path / "out" / "report.md").read_text()
    assert "Only one method was run" in text
    assert "(too few)" in text
    assert "nan" not in re.findall(r"\w+", text)


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    name = '<script>alert("1")</script>|**x**`\n# y'
    frame = pd.DataFrame([{"method": name, name: "1"}])
    section = Section(
        title=name,
        text=(name,),
        pictures=(Picture(name="p", caption=name, figure=new_figure(1, 1), data=frame),),
        tables=(Table(name="t", caption=name, shown=frame, data=frame, bold=frozenset({(0, 0)})),),
    )
    write_report(Report(title=name, summary=(name,), sections=(section,), made=((name, name),)), tmp_path)
    html, markdown = (tmp_path / "report.html").read_text(), (tmp_path / "report.md").read_text()
    assert "script" not in Page(html).tags
    assert name in "".join(Page(html).text)
    assert "<script" not in markdown
    assert "\n# y" not in markdown
    assert not re.search(r"(?<!\\)\|\\?\*\*x", markdown)
    assert list(pd.read_csv(tmp_path / "t.csv").columns) == ["method", name]


def test_the_usual_methods_and_their_reference() -> None:
    absent: dict[str, str] = {}
    usual = usual_methods(absent)
    assert {"random", "nearest", "edf", "capam", "capam-plus"} <= set(usual) <= set(method_names())
    assert "exact" not in usual
    assert reference_of(usual, None) == "capam"
    assert reference_of(["edf", "nearest"], None) == "nearest"


def test_every_method_has_a_look_of_its_own() -> None:
    methods = [*method_names(), "runs/a", "runs/b"]
    assert len({style_of(method, methods) for method in methods}) == len(methods)


def test_the_papers_numbers() -> None:
    # The means of its Table IV over the four numbers of robots, worked out from the printed table.
    means = {
        (method, tasks): sum(value for (size, _), value in cells.items() if size == tasks) / 4
        for method, cells in paper.COMPLETION.items()
        for tasks in (100, 200)
    }
    assert means["capam", 100] == pytest.approx(63.85)  # (34.6 + 51.1 + 74.9 + 94.8) / 4
    assert means["capam-p2", 100] == pytest.approx(63.875)  # (36.2 + 50.3 + 74.9 + 94.1) / 4
    assert means["capam-p1", 200] == pytest.approx(53.075)  # (24.4 + 45.2 + 66.5 + 76.2) / 4
    assert means["am", 200] == pytest.approx(43.95)  # (10.7 + 29.4 + 61.4 + 74.3) / 4
    # CapAM is said to be more than ten times faster than ILS and EILS; three of the 16 p-values are above 5 %.
    assert paper.SECONDS["eils"] / paper.SECONDS["capam"] > 10
    assert sum(p > 0.05 for cells in paper.P_VALUES.values() for p in cells.values()) == 3
