"""Pictures are offered only in formats that can be written here, which is told before anything is planned."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from command_line import Captured, fails
from matplotlib.figure import Figure

from mrta_zoo.cli.main import main
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.plot_history import main as plot_history
from mrta_zoo.show.figure import LiteralFigure, check_format, save_picture


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    path = tmp_path / "m.csv"
    path.write_text("kind,x,y,deadline,workload,capacity,speed\ntask,10,10,60,20,,\nrobot,0,0,,,1,\n")
    return path


@pytest.fixture
def no_avif(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where Pillow was built without it."""
    savefig = Figure.savefig

    def fail(figure: Figure, file: Any, *, format: str, **options: Any) -> None:
        if format == "avif":
            raise KeyError("encoder avif\nnot available")
        savefig(figure, file, format=format, **options)

    monkeypatch.setattr(Figure, "savefig", fail)


@pytest.mark.parametrize("suffix", [".pgf", ".PGF", ".raw", ".rgba", ".xyz", ".", ""])
def test_what_cannot_be_written_is_told_before_planning(
    suffix: str, mission: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr("mrta_zoo.cli.solve.solve_and_score", lambda *_: pytest.fail("it was planned"))
    out = tmp_path / f"p{suffix}"
    arguments = ["solve", str(mission), "--method", "nearest", "--plot", str(out)]
    error = fails(capsys, arguments)
    assert f"{out} has the suffix {out.suffix!r}; expected one of " in error
    assert error.endswith(".webp\n")
    assert ".pgf," not in error
    assert not out.exists()


def test_what_is_not_installed_is_told_and_not_offered(no_avif: None, mission: Path, capsys: Captured) -> None:
    arguments = ["solve", str(mission), "--method", "nearest", "--plot", str(mission.with_name("p.avif"))]
    error = fails(capsys, arguments)
    assert "p.avif has the suffix '.avif', which cannot be written here ('encoder avif\\nnot available'); " in error
    assert error.endswith(", .svg, .svgz, .tif, .tiff, .webp\n")
    assert ".avif" not in error.partition("expected")[2]


@pytest.mark.parametrize("suffix", [".PNG", ".Svg", ".eps", ".ps", ".jpg", ".JPEG", ".tif", ".webp", ".gif", ".svgz"])
def test_any_format_that_is_offered_is_written(suffix: str, mission: Path, tmp_path: Path) -> None:
    out = tmp_path / f"p{suffix}"
    figure = LiteralFigure(figsize=(1, 1))
    figure.suptitle("a")
    check_format(out)
    save_picture(figure, out)
    assert out.stat().st_size > 100


def test_solve_takes_suffixes_in_capitals(mission: Path) -> None:
    assert main(["solve", str(mission), "--method", "nearest", "--plot", str(mission.with_name("P.PNG"))]) == 0
    assert mission.with_name("P.PNG").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("out", "sentence"), [("c.pgf", "has the suffix '.pgf'"), ("a/c.png", "a does not exist")])
def test_curves_are_not_begun_where_they_cannot_be_written(tmp_path: Path, out: str, sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        plot_history((tmp_path / "absent",), out=tmp_path / out)


def test_curves_do_not_replace_what_they_are_drawn_from(tmp_path: Path) -> None:
    history = tmp_path / "history.png"
    history.write_text("update,episodes,completion\n0,0,0.25\n")
    with pytest.raises(ConfigError, match=r"--out is .*, which is the run"):
        plot_history((history,), out=history)


@pytest.mark.parametrize(("backend", "drawn_with"), [("none-such", None), ("svg", "svg")])
def test_the_environment_may_name_any_backend(backend: str, drawn_with: str | None) -> None:
    """Its own to matplotlib's windows, of which pictures need none; one that there is stays chosen."""
    code = "import mrta_zoo.eval.plot_history, mrta_zoo.eval.report.figure_style, matplotlib as m, os;" + (
        "print(dict.__getitem__(m.rcParams, 'backend'), os.environ['MPLBACKEND'])"
    )
    found = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "MPLBACKEND": backend}, capture_output=True, text=True,
        timeout=60, check=False,
    )  # fmt: skip
    assert found.stderr == ""
    chosen, left = found.stdout.split()[-2:]
    assert left == backend
    assert drawn_with is None or chosen == drawn_with
