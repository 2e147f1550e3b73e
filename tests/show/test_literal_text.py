"""What users call their files, methods and runs is never read as markup."""

from __future__ import annotations

from io import BytesIO, StringIO
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from rich.table import Table

from mrta_zoo import Scenario
from mrta_zoo.cli.main import main
from mrta_zoo.eval.converge.curves import draw_curves
from mrta_zoo.eval.plot_history import LearningCurve, draw_history
from mrta_zoo.eval.report.files import markdown
from mrta_zoo.plan import Plan
from mrta_zoo.show.figure import LiteralFigure
from mrta_zoo.show.plan.picture import draw_plan
from mrta_zoo.show.terminal.console import LiteralConsole

NAMES = ["Lot$_2_$", "Budget $5 to $9", r"a\$b$", "$x", "_hidden", r"C:\new\$tmp$", "50 % & #1 {x}^2 ~y"]
"""The first is no mathematics at all for matplotlib, the second would be shown as "Budget 5to9"."""


def shown(figure: Figure) -> list[str]:
    """The texts that a figure draws, as its back end is given them."""
    figure.savefig(BytesIO(), format="svg")
    texts = []
    for text in figure.findobj(Text):
        words, mathematics = text._preprocess_math(text.get_text())
        assert mathematics is False
        texts.append(words)
    return texts


@pytest.mark.parametrize("name", NAMES)
def test_pictures_show_names_as_they_are(name: str) -> None:
    names = {"task_names": (name, "b"), "robot_names": (f"R{name}",)}
    scenario = Scenario(task_xy=[[0, 0], [1, 9]], deadline=[9, 99], workload=[4, 4], robot_xy=[[0, 0]], capacity=[1],
                        name=name, **names)  # fmt: skip
    texts = shown(draw_plan(scenario, Plan.of([(0, 1)], name, f"m{name}")))
    assert any(text.startswith(f"{name}, planned by m{name}: ") for text in texts)


@pytest.mark.parametrize("name", NAMES)
def test_curves_show_runs_and_methods_as_they_are(name: str) -> None:
    figure = draw_history([LearningCurve(name, (0, 0, 9), (0.1, 0.2, 0.3)), LearningCurve("b", (1, 9), (0.1, 0.2))])
    texts = shown(figure)
    assert {name, f"{name}: imitates plans", "b"} <= set(texts)
    line = {"tasks": 5, "method": name, "mean_percent": 50.0, "cases": 2}
    curves = pd.DataFrame([{**line, "budget": None, "mean_seconds": 0.1}, {**line, "budget": 1.0, "mean_seconds": 1.0}])
    assert {name, f"{name}, no budget"} <= set(shown(draw_curves(curves)))


def test_tick_labels_are_literal() -> None:
    figure = LiteralFigure()
    figure.subplots().set_yticks(range(len(NAMES)), NAMES)
    assert set(NAMES) <= set(shown(figure))


@pytest.mark.parametrize("letters", ["工场", "😀", "a\tb"])
def test_letters_that_the_font_lacks_are_no_warning(letters: str) -> None:
    figure = LiteralFigure()
    figure.suptitle(letters)
    figure.savefig(BytesIO())


@pytest.mark.parametrize("name", ["[red]a", "[/]", ":smile:", "[link=x]y[/link]", "a\\[b]"])
def test_terminals_show_names_as_they_are(name: str) -> None:
    written = StringIO()
    console = LiteralConsole(file=written, width=80, force_terminal=True)
    table = Table()
    table.add_column(name)
    table.add_row(name)
    console.print(table)
    console.print(f"{name}: 5 tasks")
    assert written.getvalue().count(name) == 3


def test_nothing_in_a_name_steers_the_terminal() -> None:
    written = StringIO()
    LiteralConsole(file=written, width=80).print("a\x1b[2Jb\x9b1mc\nd")
    assert written.getvalue() == "a\\x1b[2Jb\\x9b1mc\nd\n"


def test_a_run_may_have_any_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "[red]run [/] :smile:"
    few = {"scenarios": 1, "samples": 2, "updates": 1, "epoch": 1, "validation-scenarios": 2, "imitation-updates": 0}
    flags = [f"--{name}={value}" for name, value in few.items()]
    assert main(["train", "--preset", "smoke", *flags, "--out", str(out)]) == 0
    assert capsys.readouterr().err.count(str(out)) == 2


def test_sign_of_life_shows_names_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    from mrta_zoo.show.terminal import console

    written = StringIO()
    monkeypatch.setattr(console, "messages_console", lambda: LiteralConsole(file=written, force_terminal=True))
    with console.preparing("plans [/] [red]a.csv"):
        pass
    assert "plans [/] [red]a.csv" in written.getvalue()


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("Budget $5 to $9", r"Budget \$5 to \$9"), ("# a", r"\# a"), ("- a", r"\- a"), ("+ a", r"\+ a"),
        ("1. a", r"1\. a"), ("12) a", r"12\) a"), ("> a", "&gt; a"), ("-- a", r"\-- a"),
        ("+1.5 [-1.2]", r"+1.5 \[-1.2\]"),
        ("95.5 %", "95.5 %"),
        ("a | b", r"a \| b"),
        (":smile: at 3:15", r"\:smile: at 3:15"), ("a - b # c 1. d", "a - b # c 1. d"), ("a\n\n# b", "a # b"),
        ("[a](b) `c` _d_ *e* <f> ~g~", r"\[a\](b) \`c\` \_d\_ \*e\* &lt;f&gt; \~g\~"),
    ],
)  # fmt: skip
def test_markdown_shows_text_as_it_is(text: str, written: str) -> None:
    assert str(markdown(text)) == written


@pytest.mark.parametrize("name", ["Lot$_2_$", "Budget $5 to $9"])
def test_solve_draws_whatever_the_name(tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / f"{name}.csv"
    file.write_text("kind,x,y,deadline,workload,capacity,speed\ntask,10,10,60,20,,\nrobot,0,0,,,1,\n")
    assert main(["solve", str(file), "--method", "nearest", "--plot", str(tmp_path / "d.png")]) == 0
    assert f"{name}: 1 task" in capsys.readouterr().out
