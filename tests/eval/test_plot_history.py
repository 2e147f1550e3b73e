"""Learning curves."""

from __future__ import annotations

from pathlib import Path

import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.plot_history import draw_history, main, read_history


def test_curve_is_read_and_drawn(tmp_path: Path) -> None:
    (tmp_path / "history.csv").write_text(
        "update,episodes,completion,cost,baseline_replaced\n0,0,0.25,1.5,False\n5,80,0.5,1,False\n"
    )
    curve = read_history(tmp_path)
    assert (curve.episodes, curve.completion) == ((0, 80), (0.25, 0.5))
    (line,) = draw_history([curve]).axes[0].lines
    assert list(line.get_ydata()) == [25, 50]
    main((tmp_path,), out=tmp_path / "curves.png")
    assert (tmp_path / "curves.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("text", "sentence"), [(None, "no such file"), ("a,b\n1,2\n", "not a run's history.csv")])
def test_what_is_no_history_is_refused(tmp_path: Path, text: str | None, sentence: str) -> None:
    if text is not None:
        (tmp_path / "history.csv").write_text(text)
    with pytest.raises(ConfigError, match=sentence):
        read_history(tmp_path / "history.csv")


def test_curves_of_no_run() -> None:
    with pytest.raises(ConfigError, match="no run is given; expected folders of runs"):
        main((), out=Path("curves.png"))
