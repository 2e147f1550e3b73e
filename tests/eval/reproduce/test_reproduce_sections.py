"""What the sections of the report say, on rows made by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

from mrta_zoo.cli.main import main
from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.reproduce import experiment
from mrta_zoo.eval.reproduce.completion import completion_section
from mrta_zoo.eval.reproduce.optimality import optimality_section
from mrta_zoo.eval.reproduce.paired_tests import compare, comparison_section
from mrta_zoo.eval.reproduce.results import OptimalityRow, Results, frame_of
from mrta_zoo.eval.reproduce.share import share_section
from mrta_zoo.eval.reproduce.summary import summary
from mrta_zoo.eval.reproduce.timing import times_of, timing_section
from mrta_zoo.eval.rows import Row
from mrta_zoo.suite import small_suite

Completed = Mapping[str, Sequence[int]]


def results(completed: Completed, robots: Sequence[int] = (2,) * 8, **more: object) -> Results:
    """Cases with 100 tasks, in which each method completed so many; each took 2 ms a task completed, at least 2 ms."""
    rows = [
        Row(f"c{index}", method, 100, robots[index], value, value / 100, 0.0, 0.0, 0.0, 0.002 * max(value, 1))
        for method, values in completed.items()
        for index, value in enumerate(values)
    ]
    methods = list(completed)
    cases = [f"c{index}" for index in range(len(robots))]
    fields = {"against": methods[0], **more}
    return Results(frame=frame_of(rows, cases, methods), methods=tuple(methods), seed=0, **fields)  # type: ignore[arg-type]


def small_results(rows: Sequence[tuple[str, str, int, int | None]]) -> Results:
    """Small scenarios of 5 tasks: case, method, tasks completed, and bound."""
    made = [
        OptimalityRow(case, method, 5, 1, done, done / 5, 0, 0, 0, 0.1, bound) for case, method, done, bound in rows
    ]
    frame = frame_of(made, [f"s{index}" for index in range(6)], ["exact", "nearest"])
    return results({"nearest": [50] * 8}, small=frame)


def test_verdicts() -> None:
    found = compare(
        results(
            {
                "capam": [40, 50, 60, 42, 53, 64, 45, 56],
                "worse": [30, 41, 49, 33, 42, 55, 34, 47],
                "better": [45, 56, 64, 47, 59, 69, 51, 60],
                "same": [40, 50, 60, 42, 53, 64, 45, 56],
                "alike": [41, 49, 61, 41, 54, 63, 46, 55],
                "shifted": [39, 49, 59, 41, 52, 63, 44, 55],
            }
        )
    )
    verdicts = {each.second: each.verdict for each in found}
    assert verdicts == {
        "worse": "capam better",
        "better": "better better",
        "same": "all equal",
        "alike": "no significant difference",
        "shifted": "same difference in every case",
    }
    # (10 + 9 + 11 + 9 + 11 + 9 + 11 + 9) / 8 = 79 / 8
    assert found[0].test.difference.mean == pytest.approx(79 / 8)
    # Three t-tests in the family (two pairs have none): the least p counts three times.
    least = min(found, key=lambda each: each.t_p or 1)
    assert least.t_p == pytest.approx(3 * least.test.t_p)  # type: ignore[operator]


def test_the_summary_says_who_is_better_and_where_not() -> None:
    capam = [40, 41, 42, 43, 44, 45, 46, 47, 80, 82, 84, 86, 88, 90, 92, 94]
    other = [42, 43, 43, 45, 47, 47, 48, 49, 60, 63, 64, 65, 69, 70, 70, 75]
    made = results({"capam": capam, "other": other, "same": capam}, [2] * 8 + [7] * 8)
    quiet = Machine("now", "a processor", 2, 1, "Linux", "Python 3", 0.1)
    points = summary(made, compare(made), [quiet])
    # capam (348 + 696) / 16 = 65.25, other (364 + 536) / 16 = 56.25; difference 9.
    assert points[0].endswith("mean: capam 65.2 %, same 65.2 %, other 56.2 %.")
    assert "same 0.0 [0.0, 0.0], not significant; other +9.0 [" in points[1]
    assert points[1].endswith("], significant.")
    assert not any("Beware" in point for point in points)
    busy = Machine("now", "a processor", 2, 1, "Linux", "Python 3", 3.5)
    assert "Beware: the machine was busy" in summary(made, compare(made), [busy])[-1]
    # The higher means: 65.25 of all; of other, 364 / 8, with 2 robots; of the two with 7.
    assert completion_section(made).tables[0].bold == {(0, 1), (2, 1), (1, 2), (0, 3), (2, 3)}
    # One test over all cases (same has none), two by number of robots: the lesser p counts twice.
    whole, *apart = [each for each in compare(made) if each.second == "other"]
    assert whole.t_p == whole.test.t_p
    assert min(each.t_p for each in apart) == pytest.approx(2 * min(each.test.t_p for each in apart))  # type: ignore[type-var, operator]
    _, by_robots, table = comparison_section(made, compare(made)).tables
    # With 2 robots 42 - 40 and so on: -(2 + 2 + 1 + 2 + 3 + 2 + 2 + 2) / 8 = -2.
    assert by_robots.shown.loc[0, "2 robots"].startswith("−2.00 (p ")
    assert by_robots.shown.loc[1, "7 robots"] == "0.00 (all equal)"
    assert by_robots.bold == {(0, 1), (0, 2)}
    assert table.shown["other"].tolist() == ["+9.00", "–", "+9.00"]
    assert table.shown.loc[1, "same"] == "−9.00"
    assert table.bold == {(0, 2), (1, 1), (1, 3), (2, 2)}


def test_time_for_a_mission_and_for_a_decision() -> None:
    made = results({"capam": [40] * 4 + [60] * 4, "none": [0] * 8})
    first, second = times_of(made).to_dict("records")
    # 2 ms a task: 80 ms for 40 tasks and 120 ms for 60, 100 ms in the mean; 2 ms a decision.
    assert (first["mean"], first["fastest"], first["slowest"]) == pytest.approx((0.1, 0.08, 0.12))
    assert first["per_decision"] == pytest.approx(0.002)
    shown = timing_section(results({"capam": [40, 60], "none": [0, 0]}, [2, 2]), []).tables[0].shown
    assert shown.iloc[0].tolist() == ["capam", "100 ms", "120 ms", "2 ms"]
    assert shown.iloc[1].tolist()[3] == "–"
    assert second["fastest"] == 0.002


def test_share_of_the_reference_where_there_is_one() -> None:
    cases = {"capam": [40, 45, 30, 60, 0, 20, 50, 50], "other": [50, 30, 30, 30, 0, 25, 40, 50]}
    section = share_section(results(cases, best_known={"c0": 80, "c1": 40}))
    data = section.tables[0].data.set_index("method")
    # c0 40/80 = 50 %, c1 45/40 = 112.5 %; others by the better of the two: 100, 100, 80, 100, 100; c4 nobody. / 7
    assert data.loc["capam", "mean_share"] == pytest.approx((50 + 112.5 + 100 + 100 + 80 + 100 + 100) / 7)
    # 50/80, 30/40, 30/30, 30/60, 25/25, 40/50, 50/50
    assert data.loc["other", "mean_share"] == pytest.approx((62.5 + 75 + 100 + 50 + 100 + 80 + 100) / 7)
    text = " ".join(section.text)
    assert "best in reference.csv for 2 cases, and for the other 6 the best plan that any method of this report" in text
    assert "In 1 case a method run here completed more tasks than the reference table knows of" in text
    assert "1 case in which nobody completed any task are left out" in text
    whole = share_section(results({"capam": [40] * 8}, best_known={f"c{index}": 80 for index in range(8)}))
    assert whole.text == ("Best known is the best in the reference.csv that comes with the cases, for every case.",)


def test_the_gap_counts_where_the_optimum_is_proved() -> None:
    exact = [("s0", 4, 4), ("s1", 5, 5), ("s2", 4, 4), ("s3", 3, 3), ("s4", 2, 2), ("s5", 3, 5)]
    nearest = [("s0", 4), ("s1", 4), ("s2", 3), ("s3", 3), ("s4", 1), ("s5", 3)]
    section = optimality_section(
        small_results([(c, "exact", d, b) for c, d, b in exact] + [(c, "nearest", d, None) for c, d in nearest])
    )
    data = section.tables[0].data.set_index("method")
    # s5 is not proved (3 < 5). Gaps 0/4, 1/5, 1/4, 0/3, 1/2 = 0, 20, 25, 0, 50 %: mean 19 %; 2 of 5 optimal.
    assert data.loc["nearest", "mean_gap_percent"] == pytest.approx(19)
    assert (data.loc["nearest", "optimal"], data.loc["nearest", "scenarios"]) == (2, 5)
    assert data.loc["exact", "mean_gap_percent"] == 0
    assert "proved its plan optimal in 5 of them" in section.text[0]
    assert section.text[1] == "No method ever completed more tasks than exact proved possible, as it must be."


def test_beating_the_optimum_is_an_error_said_aloud() -> None:
    rows = [("s0", "exact", 4, 4.0), ("s0", "nearest", 5, None), ("s1", "exact", 3, 4.0), ("s1", "nearest", 4, None)]
    text = optimality_section(small_results(rows)).text[1]
    assert text.startswith("ERROR: 1 plan completed more tasks than exact proved possible (nearest on s0)")


def test_without_an_exact_solver_the_section_says_what_is_missing() -> None:
    section = optimality_section(results({"nearest": [50] * 8}, absent={"exact": "this version has no method exact"}))
    assert section.text == ("Not measured, because this version has no method exact.",)


def test_the_command_runs_the_small_scenarios_where_it_can(
    monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("exact")
    few = [scenario for scenario in small_suite() if scenario.num_robots == 1 and scenario.num_tasks == 5]
    monkeypatch.setattr(experiment, "small_suite", lambda: few)
    assert main(["generate", "--count", "2", "--tasks", "6", "--robots", "1", "--out", str(folder / "cases")]) == 0
    flags = ["--cases", str(folder / "cases"), "--methods", "nearest,edf", "--out", str(folder / "out")]
    assert main(["reproduce", *flags]) == 0
    text = (folder / "out" / "report.md").read_text()
    assert "exact proved its plan optimal in 4 of them." in text
    assert "No method ever completed more tasks" in text
    assert (folder / "out" / "optimality_gap.csv").exists()
    rows = (folder / "out" / "small_rows.csv").read_text()
    assert rows.count("\n") == 1 + 3 * 4
