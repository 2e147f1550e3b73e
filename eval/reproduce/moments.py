"""CapAM with P = 1, 2, 3 and AM at one and two times the size trained on: Table IV of the paper."""

from __future__ import annotations

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Section, Table
from mrta_zoo.eval.reproduce import paper
from mrta_zoo.eval.reproduce.completion import case_counts
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.wording import counted


def moments_section(results: Results) -> Section:
    """Our policies beside the paper's, by number of tasks and robots."""
    title = "CapAM with P = 1, 2, 3, and AM, at one and two times the size"
    present = [method for method in paper.NAMES if method in results.methods]
    lacking = [f"{method} ({name})" for method, name in paper.NAMES.items() if method not in present]
    text = []
    if lacking:
        text.append(
            f"Not among the methods that were run: {wording.listed(lacking)}. A policy that does not ship with this "
            "version can be trained (mrta-zoo train --preset fast --moments 1, or --encoder am) into a folder of that "
            "name, which is then named in --methods."
        )
    if not present:
        return Section(title=title, text=tuple(text))
    text.append(paper.CAVEAT)
    text.append(
        "Each of our columns is one trained network. A difference between two of them may come from training as well "
        "as from P or the encoder: only several trainings of each could tell."
        if len(present) > 1
        else "Our column is one trained network."
    )
    shown: list[dict[str, str]] = []
    data, bold = [], set()
    for tasks in results.sizes:
        for group in results.groups(tasks):
            if group.robots is None:
                continue
            cells: dict[str, str] = {"tasks": str(tasks), "robots": str(group.robots)}
            found = {method: results.estimate(group, method, "percent") for method in present}
            best = max(estimate.mean for estimate in found.values())
            for method, estimate in found.items():
                if len(present) > 1 and estimate.mean == best:
                    bold.add((len(shown), len(cells)))
                cells[method] = wording.percentage(estimate)
            for method, name in paper.NAMES.items():
                theirs = paper.COMPLETION[method].get((tasks, group.robots))
                cells[f"paper: {name}"] = wording.DASH if theirs is None else f"{theirs:.1f}"
                if method in found:
                    data.append(
                        {
                            "tasks": tasks, "robots": group.robots, "policy": method, "cases": found[method].n,
                            "mean_percent": found[method].mean, "low": found[method].low,
                            "high": found[method].high, "paper_percent": theirs,
                        }
                    )  # fmt: skip
            shown.append(cells)
    counts = " ".join(f"{counted(tasks, 'task')}: {case_counts(results, tasks)}" for tasks in results.sizes)
    caption = (
        f"Tasks completed in time, mean % with its {wording.INTERVAL} in brackets (BCa bootstrap over cases), of our "
        f"policies; and the paper’s Table IV ({paper.SOURCE}), 24 other cases a line, without intervals. {counts}"
        f"{' Bold: the highest of ours.' if len(present) > 1 else ''}"
    )
    table = Table(
        name="capam_p_and_am", caption=caption, shown=pd.DataFrame(shown), data=pd.DataFrame(data), bold=frozenset(bold)
    )
    return Section(title=title, text=tuple(text), tables=(table,))
