"""How close each method comes to the best known plan."""

from __future__ import annotations

from dataclasses import replace

from mrta_zoo.eval.report.parts import Section
from mrta_zoo.eval.reproduce.completion import estimate_table
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.wording import counted


def share_section(results: Results) -> Section:
    """Tasks completed as % of what the best known plan completes."""
    title = "Share of the best known plan"
    frame = results.frame
    best_here = frame.groupby("case")["completed"].transform("max")
    reference = frame["case"].map(dict(results.best_known))
    best = reference.fillna(best_here).astype(float)
    known = results.frame["case"].isin(frame.loc[best > 0, "case"])
    with_reference = frame.loc[reference.notna(), "case"].nunique()
    cases = frame["case"].nunique()
    beaten = frame.loc[best_here > best, "case"].nunique()
    text = [_basis(with_reference, cases)]
    if beaten:
        text.append(
            f"In {counted(beaten, 'case')} a method run here completed more tasks than the reference table "
            "knows of; shares above 100 % are such cases."
        )
    if not known.all():
        text.append(
            f"{counted(cases - frame.loc[known, 'case'].nunique(), 'case')} in which nobody completed any task "
            "are left out."
        )
    shares = replace(results, frame=frame.assign(share=100 * frame["completed"] / best)[known])
    if shares.frame.empty:
        return Section(title=title, text=tuple(text))
    tables = [
        estimate_table(
            shares, tasks, "share", f"share_of_best_{tasks}",
            f"Tasks completed, mean % of the tasks of the best known plan, {counted(tasks, 'task')}.",
        )
        for tasks in shares.sizes
    ]  # fmt: skip
    return Section(title=title, text=tuple(text), tables=tuple(tables))


def _basis(with_reference: int, cases: int) -> str:
    if with_reference == cases:
        return "Best known is the best in the reference.csv that comes with the cases, for every case."
    run = (
        "the best plan that any method of this report found. That is no bound: with other methods run, shares would "
        "differ, and the best of those run gets close to 100 % by itself"
    )
    if not with_reference:
        return f"The cases come without a reference.csv, so best known is {run}."
    return (
        f"Best known is the best in reference.csv for {counted(with_reference, 'case')}, and for the other "
        f"{cases - with_reference} {run}."
    )
