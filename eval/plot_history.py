"""Learning curves of training runs as a picture.

``python -m mrta_zoo.eval.plot_history runs/a runs/b --out curves.png``; needs matplotlib (``mrta_zoo[plot]``).
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.paths import as_spelt
from mrta_zoo.io.text_files import check_name, read_text
from mrta_zoo.show.axes import plain
from mrta_zoo.show.figure import LiteralFigure, check_format, save_picture


@dataclass(frozen=True, slots=True)
class LearningCurve:
    """Validation completion of one run.

    Attributes:
        name: what the legend calls it.
        episodes: missions sampled so far, for each validation; 0 as long as plans are imitated.
        completion: greedy completion rate then, 0..1.
        updates: gradient steps so far, for each validation; empty if not known.
    """

    name: str
    episodes: tuple[int, ...]
    completion: tuple[float, ...]
    updates: tuple[int, ...] = ()


def read_history(path: Path) -> LearningCurve:
    """The curve in a run's folder, or in a copy of its history.csv.

    Raises:
        ConfigError: if there is none, or it is malformed.
    """
    file = as_spelt(path / "history.csv") if path.is_dir() else path
    text = read_text(file, ConfigError, "a run's history.csv")
    name = path.absolute().name if path.is_dir() else path.stem
    check_name(name, str(path), "the run's name", ConfigError)
    try:
        rows = [row for row in csv.DictReader(io.StringIO(text)) if any(row.values())]
        if not rows:
            raise ValueError("it has no rows")
        return LearningCurve(
            name=name,
            episodes=tuple(int(row["episodes"]) for row in rows),
            updates=tuple(int(row["update"]) for row in rows),
            completion=tuple(float(row["completion"]) for row in rows),
        )
    except (KeyError, TypeError, ValueError, csv.Error) as error:
        raise ConfigError(f"{file}: not a run's history.csv ({error})") from None


def draw_history(curves: list[LearningCurve], by: Literal["episodes", "updates"] = "episodes") -> LiteralFigure:
    """Completion in percent against episodes or updates, one line a run; dots where plans are still imitated."""
    figure = LiteralFigure(figsize=(8, 4.2), layout="constrained")
    axes = figure.add_subplot()
    named: list[tuple[Any, str]] = []  # to matplotlib itself, a label that begins with _ is none
    for curve, colour in zip(
        curves, ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9") * 9, strict=False
    ):
        along, percent = getattr(curve, by), [100 * each for each in curve.completion]
        (line,) = axes.plot(along, percent, color=colour, linewidth=1.5)
        named.append((line, curve.name))
        imitated = sum(episodes == 0 for episodes in curve.episodes)
        if imitated > 1:
            (dots,) = axes.plot(along[:imitated], percent[:imitated], "o", color=colour)
            named.append((dots, f"{curve.name}: imitates plans"))
    axes.set_xlabel("episodes sampled" if by == "episodes" else "updates")
    axes.set_ylabel("validation completion, %")
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    plain(axes)
    axes.legend(*zip(*named, strict=True), frameon=False, loc="lower right")
    return figure


def main(
    runs: Annotated[tuple[Path, ...], tyro.conf.Positional],
    /,
    out: Path,
    by: Literal["episodes", "updates"] = "episodes",
) -> None:
    """Draw the learning curves of training runs.

    Args:
        runs: folders of runs, or copies of their history.csv.
        out: the picture: .png, .svg, .pdf…
        by: what goes along: episodes sampled, or updates.

    Raises:
        ConfigError: if there is no run, one has no history, or the picture cannot be written.
    """
    if not runs:
        raise ConfigError("no run is given; expected folders of runs, or copies of their history.csv")
    check_outputs({"--out": out}, {f"the run {run}": run for run in runs})
    check_format(out)
    save_picture(draw_history([read_history(run) for run in runs], by), out, dpi=130)


if __name__ == "__main__":
    tyro.cli(main, prog="python -m mrta_zoo.eval.plot_history")
