"""How far each method is from the optimum, on scenarios so small that an exact solver proves it."""

from __future__ import annotations

import pandas as pd

from mrta_zoo.digits import share
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Section, Table
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.eval.significance import estimate_mean
from mrta_zoo.wording import counted

EXACT = "exact"
TITLE = "Optimality gap on small scenarios"


def optimality_section(results: Results) -> Section:
    """Mean gap, share solved to optimality, and whether anyone ever beat the exact solver."""
    if results.small is None:
        reason = results.absent.get(EXACT, f"the method {EXACT} was not run")
        return Section(title=TITLE, text=(f"Not measured, because {reason}.",))
    frame = results.small
    exact = frame[frame["method"] == EXACT].set_index("case")
    proved = exact.index[exact["completed"] >= exact["bound"]]
    optimum = frame["case"].map(exact["completed"])
    impossible = frame[frame["completed"] > frame["case"].map(exact["bound"])]
    judged = frame.assign(
        optimum=optimum, gap=(100 * (optimum - frame["completed"]) / optimum.where(optimum > 0)).fillna(0.0)
    )[frame["case"].isin(proved)]
    text = [
        f"{len(exact)} generated scenarios with {frame['tasks'].min()} to {frame['tasks'].max()} tasks and "
        f"{frame['robots'].min()} to {frame['robots'].max()} robots, frozen seeds; {EXACT} proved its plan optimal in "
        f"{len(proved)} of them" + (", and only those count here." if len(proved) < len(exact) else "."),
        _beaten(impossible),
    ]
    if not len(proved):
        return Section(title=TITLE, text=tuple(text))
    shown, data = [], []
    for method, rows in judged.groupby("method", sort=False):
        gap = estimate_mean(rows["gap"].to_numpy(float), results.seed)
        optimal, off = int((rows["completed"] == rows["optimum"]).sum()), rows["optimum"] - rows["completed"]
        shown.append(
            {
                "method": method,
                "mean gap, %": wording.percentage(gap),
                "optimal": f"{optimal} of {len(rows)} ({share(optimal / len(rows))} %)",
                "largest gap, tasks": str(int(off.max())),
                "mean time": wording.seconds(rows["seconds"].mean()),
            }
        )
        data.append(
            {"method": method, "scenarios": len(rows), **gap.columns("mean_gap_percent"), "optimal": optimal,
             "mean_seconds": rows["seconds"].mean()}
        )  # fmt: skip
    table = Table(
        name="optimality_gap",
        caption="Gap: tasks that the best plan completes and the method does not, in % of those the best plan "
        f"completes, mean with its {wording.INTERVAL} in brackets (BCa bootstrap over scenarios); how often the method "
        f"was optimal, and by how many tasks it was off at most. n = {counted(len(proved), 'scenario')}. Trained "
        "methods have learned on 50 tasks and more, so these are far from what they know.",
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    return Section(title=TITLE, text=tuple(text), tables=(table,))


def _beaten(impossible: pd.DataFrame) -> str:
    if impossible.empty:
        return f"No method ever completed more tasks than {EXACT} proved possible, as it must be."
    names = ", ".join(f"{line.method} on {line.case}" for line in impossible.head(5).itertuples())
    return (
        f"ERROR: {counted(len(impossible), 'plan')} completed more tasks than {EXACT} proved possible "
        f"({names}): there is a mistake in the exact solver, the verifier or the rules, and this section must not "
        "be used."
    )
