"""Experiments that can be interrupted: rows on disk, and what a folder must not be mixed with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest

from mrta_zoo.cli.cases import read_all, shown_cases
from mrta_zoo.cli.main import main
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.cells import Cell, Tell, case_cells
from mrta_zoo.eval.converge.curves import BudgetRow
from mrta_zoo.eval.experiment import MANIFEST, Experiment, open_folder
from mrta_zoo.eval.manifest import Manifest, digest_of_cases, digest_of_weights, make_manifest
from mrta_zoo.eval.rows import KEY, Row
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.eval.runner import NamedSolver, row_of
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.io import Case, write_scenario
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario

CASES = [
    Case(name, UniformGenerator(tasks=(6, 6), robots=(2, 2))(np.random.default_rng(index), name))
    for index, name in enumerate(("a", "b,c", 'd"e'))
]
ROW = Row("a,b", 'quo"te', 100, 2, 30, 0.3, 1 / 3, 1e-7, 12.5, 0.25)
MANIFEST_NOW = Manifest(command="reproduce", settings={"cases": "x", "budget": None}, cases="1", weights={"capam": "2"})


class InterruptedHereError(Exception):
    pass


class Breaks:
    """Plans like `nearest` until it has planned so many missions."""

    def __init__(self, after: int) -> None:
        self.left, self.inner, self.solved = after, make_solver("nearest"), []  # type: ignore[var-annotated]

    def solve(self, scenario: Scenario) -> Plan:
        if not self.left:
            raise InterruptedHereError
        self.left -= 1
        self.solved.append(scenario.name)
        return self.inner.solve(scenario)


def measured(folder: Path, solver: Solver, name: str = "m", cases: Sequence[Case] = CASES) -> list[Row]:
    """The rows of all cases by one method, of which the folder may hold some."""
    cells = case_cells(cases, NamedSolver(name, solver), row_of)
    return Experiment(folder, MANIFEST_NOW).measure("rows.csv", Row, KEY, cells)


def test_rows_read_back_as_they_were(tmp_path: Path) -> None:
    file = RowsFile(tmp_path / "rows.csv", BudgetRow)
    rows = [BudgetRow(*astuple(ROW), budget=0.3), BudgetRow(*astuple(ROW))]
    for row in rows:
        file.append(row)
        assert RowsFile(tmp_path / "rows.csv", BudgetRow).rows == file.rows
    assert file.rows == rows


@pytest.mark.parametrize("cut", [1, 5, 30])
def test_an_unfinished_line_is_dropped(tmp_path: Path, cut: int) -> None:
    path = tmp_path / "rows.csv"
    for case in ("a", "b"):
        RowsFile(path, Row).append(replace(ROW, case=case))
    whole = path.read_text()
    path.write_text(whole[:-cut])
    file = RowsFile(path, Row)
    assert [row.case for row in file.rows] == ["a"]
    file.append(replace(ROW, case="b"))
    assert path.read_text() == whole


def test_even_an_unfinished_header_is_mended(tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    path.write_text("case,meth")
    RowsFile(path, Row).append(ROW)
    assert RowsFile(path, Row).rows == [ROW]


@pytest.mark.parametrize(
    ("line", "sentence"),
    [("a,b\n", "line 1: the columns are"), (None, "line 2: 2 cells; expected 10"), ("x", "Expected `int`")],
)
def test_malformed_rows_are_refused(tmp_path: Path, line: str | None, sentence: str) -> None:
    path = tmp_path / "rows.csv"
    RowsFile(path, Row).append(ROW)
    header, row = path.read_text().splitlines()
    path.write_text(
        {None: f"{header}\na,b\n", "x": f"{header}\n{row.replace(',100,', ',many,')}\n"}.get(line, line or "")
    )
    with pytest.raises(ConfigError, match=sentence):
        RowsFile(path, Row)


@pytest.mark.parametrize("at", [0, 3, 10])
def test_empty_columns_of_a_spreadsheet_are_passed_over(tmp_path: Path, at: int) -> None:
    path = tmp_path / "rows.csv"
    RowsFile(path, Row).append(replace(ROW, case="a", method="m"))
    lines = [line.split(",") for line in path.read_text().splitlines()]
    path.write_text("".join(",".join([*line[:at], "", *line[at:]]) + "\n" for line in lines) + ",,,,\n")
    file = RowsFile(path, Row)
    file.append(replace(ROW, case="b", method="m"))
    assert [row.case for row in RowsFile(path, Row).rows] == ["a", "b"]
    path.write_text("".join(",".join([*line[:at], "7", *line[at:]]) + "\n" for line in lines))
    with pytest.raises(ConfigError, match="line 1: the columns are"):
        RowsFile(path, Row)


def test_an_interruption_costs_one_case(tmp_path: Path) -> None:
    with pytest.raises(InterruptedHereError):
        measured(tmp_path / "out", Breaks(after=2))
    assert [row.case for row in RowsFile(tmp_path / "out" / "rows.csv", Row).rows] == ["a", "b,c"]
    second = Breaks(after=9)
    resumed = measured(tmp_path / "out", second)
    assert second.solved == ['d"e']
    whole = measured(tmp_path / "whole", make_solver("nearest"))
    assert [replace(row, seconds=0) for row in resumed] == [replace(row, seconds=0) for row in whole]
    assert RowsFile(tmp_path / "out" / "rows.csv", Row).rows == resumed
    assert len(Experiment(tmp_path / "out", MANIFEST_NOW).machines) == 2  # of two sessions


def test_a_cell_is_whole_or_done_again(tmp_path: Path) -> None:
    """Of several rows, and with something beside them that may be lost."""
    performed, kept = [], {"x": True, "y": True}

    def cell(method: str) -> Cell[Row]:
        rows = [replace(ROW, case=case, method=method) for case in ("one", "two")]

        def perform(tell: Tell) -> list[Row]:
            performed.append(method)
            tell(0.5)
            return rows

        keys = tuple((row.case, row.method) for row in rows)
        return Cell(label=method, keys=keys, perform=perform, kept=lambda: kept[method])

    path, cells = tmp_path / "rows.csv", [cell("x"), cell("y")]

    def go() -> list[tuple[str, str]]:
        return [
            (row.method, row.case) for row in Experiment(tmp_path, MANIFEST_NOW).measure("rows.csv", Row, KEY, cells)
        ]

    assert go() == go() == [("x", "one"), ("x", "two"), ("y", "one"), ("y", "two")]
    assert performed == ["x", "y"]
    whole = path.read_text()
    path.write_text(whole[: whole.index("two")])  # killed while the rows of x were written
    assert len(go()) == 4
    assert performed == ["x", "y", "x", "y"]
    kept["x"] = False
    assert len(go()) == 4
    assert performed[4:] == ["x"]
    assert path.read_text() == whole  # in the order of the cells, though x was done last


def test_a_folder_is_opened_again_by_the_same_command_only(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "out"
    open_folder(folder, MANIFEST_NOW)
    (folder / "rows.csv").write_text("")
    open_folder(folder, MANIFEST_NOW)
    for other, sentence in (
        (replace(MANIFEST_NOW, command="converge"), "the command was reproduce, now it is converge"),
        (replace(MANIFEST_NOW, version="9"), "made by version .*, this is 9"),
        (replace(MANIFEST_NOW, settings={"cases": "x", "budget": 2.0}), "budget was not given, now it is 2.0"),
        (replace(MANIFEST_NOW, settings={"cases": "y", "budget": None}), "cases was x, now it is y"),
        (replace(MANIFEST_NOW, cases="9"), "the cases have changed"),
        (replace(MANIFEST_NOW, weights={"capam": "9"}), "the weights of capam have changed"),
    ):
        with pytest.raises(ConfigError, match=f"out holds results of another run: .*{sentence}.*; expected the same"):
            open_folder(folder, other)


def test_foreign_folders_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="file is a file"):
        open_folder(tmp_path / "file", MANIFEST_NOW)
    with pytest.raises(ConfigError, match=r"is not empty and holds no manifest\.json"):
        open_folder(tmp_path, MANIFEST_NOW)
    (tmp_path / MANIFEST).write_text('{"mine": true}')
    with pytest.raises(ConfigError, match="expected what this command has written there"):
        open_folder(tmp_path, MANIFEST_NOW)
    assert sorted(path.name for path in tmp_path.glob("[!.]*")) == ["file", MANIFEST]


def test_digests_tell_cases_and_weights_apart(tmp_path: Path) -> None:
    digest = digest_of_cases(CASES)
    assert digest == digest_of_cases(list(CASES))
    moved = replace(CASES[0], scenario=replace(CASES[0].scenario, deadline=CASES[0].scenario.deadline + 1e-9))
    for other in (CASES[:2], CASES[::-1], [moved, *CASES[1:]], [replace(CASES[0], best_known=3), *CASES[1:]]):
        assert digest_of_cases(other) != digest
    assert digest_of_weights("capam") != digest_of_weights("capam-plus")
    with pytest.raises(ConfigError, match="no such file"):
        digest_of_weights(str(tmp_path))
    assert list(make_manifest("eval", {}, CASES, ["nearest", "capam"]).weights) == ["capam"]


def test_digests_stay_those_of_experiments_begun_earlier() -> None:
    scenario = Scenario([[1, 2], [3, 4]], [5, 6], [0, 1], [[7, 8]], [2], speed=[0.5], map_size=(9, 10), name="a")  # type: ignore[arg-type]
    assert digest_of_cases([Case("a", scenario, 1)]).startswith("757b9174faa106e2c17f7a88a4eb3a62685cf6f8c841")


def test_digests_tell_where_the_map_lies() -> None:
    where = replace(CASES[0], scenario=replace(CASES[0].scenario, map_origin=(-0.1, 0.0)))
    assert digest_of_cases([where]) != digest_of_cases(CASES[:1])
    at_nought = replace(CASES[0], scenario=replace(CASES[0].scenario, map_origin=(0.0, 0.0)))
    assert digest_of_cases([at_nought]) == digest_of_cases(CASES[:1])


def test_accents_may_be_written_in_two_ways(tmp_path: Path) -> None:
    """As one character or two: of methods, cases and settings, in what was kept and in what is asked for now."""
    one, two = "caf\u00e9", "cafe\u0301"
    for spelt in (two, one, two):
        case = replace(CASES[0], name=spelt)
        cases = digest_of_cases([case])
        manifest = Manifest(command="c", settings={"m": [spelt]}, cases=cases, weights={spelt: ""})
        cells = case_cells([case], NamedSolver(spelt, make_solver("nearest")), row_of)
        assert len(Experiment(tmp_path / "out", manifest).measure("rows.csv", Row, KEY, cells)) == 1
        assert len(RowsFile(tmp_path / "out" / "rows.csv", Row).rows) == 1


def test_a_method_whose_path_has_accents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from mrta_zoo.policies.neural.capam.config import NetworkConfig
    from mrta_zoo.policies.neural.sharing import build_network
    from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy

    monkeypatch.chdir(tmp_path)
    config = NetworkConfig(embedding=32, heads=4)
    two = "cafe\u0301.safetensors"
    save_policy(Path(two), build_network(config, "shared", 1, seed=0), PolicyInfo(network=config))
    Path("cases").mkdir()
    for case in CASES:
        write_scenario(case.scenario, f"cases/{case.scenario.name}.csv")
    for line in (
        f"reproduce --cases cases --methods nearest,{two} --against {two} --out report",
        f"converge --cases cases --methods {two} --points nearest --budgets 0.01 --out curves",
    ):
        for _ in range(2):
            assert main(line.split()) == 0
    assert main(f"eval --cases cases --methods {two},caf\u00e9.safetensors".split()) == 2


def test_cases_of_several_folders(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        write_scenario(CASES[0].scenario, tmp_path / folder / f"{folder}.csv")
    found = read_all(f"{tmp_path}/one, {tmp_path}/two")
    assert [case.name for case in found] == ["one", "two"]
    assert shown_cases(f"{tmp_path}/one/,{tmp_path}/two") == "one,two"
    assert shown_cases(f"builtin,{tmp_path}/one") == "suite-100,one"
    assert [len(read_all("builtin")), len(read_all("suite-100, suite-200"))] == [96, 192]
    assert [case.name for case in read_all(f"suite-200,{tmp_path}/one")][-1] == "one"
    with pytest.raises(ConfigError, match="suite-100 is named twice"):
        read_all("builtin,suite-100")
    (tmp_path / "two" / "one.csv").write_bytes((tmp_path / "one" / "one.csv").read_bytes())
    found = read_all(f"{tmp_path}/one,{tmp_path}/two")
    assert [case.name for case in found] == ["one", "two/one", "two"]
    assert found[1].scenario.name == "one"
    with pytest.raises(ConfigError, match="is named twice"):
        read_all(f"{tmp_path}/one,{tmp_path}/one")


def test_two_runs_cannot_share_a_folder(tmp_path: Path) -> None:
    from filelock import FileLock

    folder = tmp_path / "out"
    folder.mkdir()
    with FileLock(folder / ".lock"), pytest.raises(ConfigError, match="is in use by another run"):
        open_folder(folder, make_manifest("reproduce", {}, CASES, []))
    open_folder(folder, make_manifest("reproduce", {}, CASES, []))


@pytest.mark.parametrize(
    ("case", "sentence"),
    [
        ("a", r"rows\.csv has two rows for case a, method m; expected one"),
        ("zz", r"rows\.csv has a row for case zz, method m, which this command does not ask for"),
    ],
)
def test_rows_that_nobody_asked_for_are_refused(tmp_path: Path, case: str, sentence: str) -> None:
    measured(tmp_path, make_solver("nearest"))
    RowsFile(tmp_path / "rows.csv", Row).append(replace(ROW, case=case, method="m"))
    with pytest.raises(ConfigError, match=sentence):
        measured(tmp_path, make_solver("nearest"))


def test_garbage_that_csv_cannot_hold_is_refused(tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text("x" * 200_000 + "\n")
    with pytest.raises(ConfigError, match="field larger than field limit"):
        RowsFile(tmp_path / "rows.csv", Row)


@pytest.mark.parametrize("command", ["reproduce", "converge", "ablate", "sharing"])
def test_ctrl_c_says_how_to_go_on(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*args: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr("mrta_zoo.cli.flags.parse", interrupted)
    assert main([command, "--out", "x"]) == 130
    assert capsys.readouterr().err == "the same command goes on where it stopped\ninterrupted\n"


def test_an_experiment_may_lie_behind_links(tmp_path: Path) -> None:
    (tmp_path / "out").symlink_to(tmp_path / "elsewhere")
    manifest = make_manifest("test", {}, [], [])
    open_folder(tmp_path / "out", manifest)
    open_folder(tmp_path / "out", manifest)
    (tmp_path / "out" / "rows.csv").symlink_to(tmp_path / "rows")
    row = Row("a", "m", 1, 1, 1, 1.0, 0.0, 0.0, 0.0, 0.0)
    for count in (1, 2):
        RowsFile(tmp_path / "out" / "rows.csv", Row).append(row)
        assert RowsFile(tmp_path / "rows", Row).rows == [row] * count
    assert (tmp_path / "out").is_symlink()
    assert (tmp_path / "elsewhere" / "rows.csv").is_symlink()
