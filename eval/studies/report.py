"""A study as a report: claims, differences, tasks completed, what is particular to the study, learning curves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from mrta_zoo.digits import percentage
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import new_figure
from mrta_zoo.eval.report.forest import Mark, draw_forest
from mrta_zoo.eval.report.made import how_made
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.significance import SIGNIFICANT, Estimate
from mrta_zoo.eval.studies.effects import equal_weights, run_values
from mrta_zoo.eval.studies.study import MATTERS, Contrast, Study
from mrta_zoo.extras import importing
from mrta_zoo.show.axes import plain
from mrta_zoo.show.palette import FAINT, INK
from mrta_zoo.wording import counted

with importing("report", "a figure"):
    from matplotlib.figure import Figure

COLOURS = (INK, "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00")
COLUMNS = 3
"""Panels in a line, at most."""
NOT_FLAGS = ("validations", "validation_scenarios")
"""Settings that the command has no flag for."""


def study_report(study: Study, own: Sequence[Section] = ()) -> Report:
    """A study as a report.

    Args:
        study: what was asked, and what was found.
        own: sections that only this study has.
    """
    flags = {name: value for name, value in study.manifest.settings.items() if name not in NOT_FLAGS}
    each_run = (
        f"{study.design.each_run}; TAPTC-like scenarios with {counted(study.design.budget.tasks, 'task')}, mask rule "
        "feasible, objective completion, baseline samples, unless the arm says otherwise; the policy with the best "
        "validation counts"
    )
    return Report(
        title=study.design.title,
        summary=(
            *(
                wording.contrast(each.claim.name, each.effect.difference, each.effect.significant)
                + f": {each.verdict}. {each.claim.says}"
                for each in study.answers
            ),
            *_in_short(study),
        ),
        sections=(
            *([_claims(study)] if study.answers else ()),
            _differences(study),
            _completion(study),
            *own,
            _curves(study),
        ),
        made=how_made(study.manifest, flags, study.machines, [("Each run", each_run)]),
    )


def _in_short(study: Study) -> list[str]:
    """The differences of each question in one line."""
    return [
        f"{question.title}, against {question.reference}, percentage points: "
        + "; ".join(
            wording.contrast(each.named(each.arm), each.effect.difference, each.effect.significant)
            for each in study.contrasts
            if each.question is question
        )
        + "."
        for question in study.design.questions
    ]


def _intervals(study: Study) -> str:
    return (
        f"In brackets the {wording.INTERVAL}: Student’s, from the scatter of training runs ({study.design.scatter}) "
        "and of scenarios (paired), with Satterthwaite’s degrees of freedom."
    )


def _claims(study: Study) -> Section:
    shown = [
        {
            "claim": answer.claim.name,
            "percentage points": wording.estimate(answer.effect.difference),
            "p, adjusted": wording.p_value(answer.effect.adjusted_p),
            "verdict": answer.verdict,
        }
        for answer in study.answers
    ]
    data = [
        {"claim": answer.claim.name, **answer.effect.columns, "verdict": answer.verdict, "measured": answer.claim.says}
        for answer in study.answers
    ]
    caption = (
        f"{_intervals(study)} P-values are adjusted for the number of claims (Holm). Supported: the adjusted p-value "
        f"is below {SIGNIFICANT:g} and the difference as claimed. Not supported: the interval ends below "
        f"+{MATTERS:g} point. Undecided: neither. These are small networks early in training: the paper’s are larger "
        "and saw some 50 million episodes with 100 tasks."
    )
    table = Table(name="claims", caption=caption, shown=pd.DataFrame(shown), data=pd.DataFrame(data))
    return Section(title="The paper’s claims", tables=(table,))


def _differences(study: Study) -> Section:
    numbers = study.design.held_out.robots
    shown, data = [], []
    for each in study.contrasts:
        cells = {robots: wording.number(effect.difference.mean) for robots, effect in each.by_robots.items()}
        shown.append(
            {
                "question": each.question.title,
                "difference": f"{each.named(each.arm)} − {each.question.reference}",
                _mean_over(study): wording.estimate(each.effect.difference),
                "p, adjusted": wording.p_value(each.effect.adjusted_p),
                **{counted(robots, "robot"): cells.get(robots, wording.DASH) for robots in numbers},
            }
        )
        data += [
            {"question": each.question.name, "held_out": each.distribution, "arm": each.arm,
             "reference": each.question.reference, "robots": robots, **effect.columns}
            for robots, effect in (("mean", each.effect), *each.by_robots.items())
        ]  # fmt: skip
    caption = (
        "% of tasks completed, arm minus reference, in percentage points. "
        f"{_intervals(study)} P-values are adjusted within each question (Holm), intervals are not. "
    )
    picture = Picture(
        name="differences",
        caption=f"{caption}Filled: adjusted p-value below {SIGNIFICANT:g}. Mean over numbers of robots.",
        figure=_draw_forest(study),
    )
    table = Table(
        name="differences",
        caption=f"{caption}Intervals by number of robots are in the CSV.",
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    text = (
        "So few runs of an arm say little about how much its runs scatter: a difference that is not significant may "
        "well be there. More --seeds narrow the intervals.",
    )
    return Section(title="Differences", text=text, pictures=(picture,), tables=(table,))


def _draw_forest(study: Study) -> Figure:
    """All differences, question by question."""
    lines: list[Contrast | str] = []
    for question in study.design.questions:
        lines.append(f"{question.title}, against {question.reference}")
        lines += [each for each in study.contrasts if each.question is question]
    rows = [each if isinstance(each, str) else each.named(study.design.arms[each.arm].title) for each in lines]
    marks = {
        row: Mark(each.effect.difference, ("#0072b2", "o"), each.effect.significant)
        for row, each in enumerate(lines)
        if not isinstance(each, str)
    }
    return draw_forest(rows, {"": marks}, "difference in tasks completed, percentage points", width=7.6)


@dataclass(frozen=True, slots=True)
class _Line:
    """% completed by an arm on the held-out scenarios of a distribution.

    Attributes:
        arm: its name.
        title: for people.
        held_out: the distribution.
        means: by number of robots, and "mean" over those that are compared.
        runs: the mean of each run, as text.
        gain: by how many points training improved validation, as text.
    """

    arm: str
    title: str
    held_out: str
    means: Mapping[int | str, Estimate]
    runs: str = wording.DASH
    gain: str = wording.DASH


def _lines(study: Study) -> Iterator[_Line]:
    """A line for each arm and distribution, then for the nearest-feasible rule."""
    design = study.design
    sets: dict[int | str, tuple[int, ...]] = {each: (each,) for each in design.held_out.robots}
    sets["mean"] = design.compared
    for name, arm in design.arms.items():
        served, gain = set(study.served(name)), wording.number(study.gain(name))
        for distribution in design.distributions:
            if (name, distribution) in study.runs:
                means = {key: study.mean(name, distribution, each) for key, each in sets.items() if served >= {*each}}
                of_runs = run_values(study.runs[name, distribution], equal_weights(design.compared))
                yield _Line(name, arm.title, distribution, means, ", ".join(map(percentage, of_runs)), gain)
    for distribution in design.distributions:
        means = {key: study.nearest(distribution, each) for key, each in sets.items()}
        yield _Line("nearest", "the nearest feasible task", distribution, means)


def _completion(study: Study) -> Section:
    shown, data = [], []
    for line in _lines(study):
        cells = {key: wording.percentage(value) for key, value in line.means.items()}
        shown.append(
            {"arm": line.arm, "what": line.title, "held out": line.held_out,
             **{counted(each, "robot"): cells.get(each, "no network") for each in study.design.held_out.robots},
             _mean_over(study): cells["mean"], "each run": line.runs, "gain": line.gain}
        )  # fmt: skip
        data += [
            {"arm": line.arm, "held_out": line.held_out, "robots": key, **value.columns("percent")}
            for key, value in line.means.items()
        ]
    caption = (
        f"Tasks completed in time, mean %, in one greedy pass, on {study.design.held_out.count} held-out scenarios for "
        f"each number of robots; in brackets the {wording.INTERVAL}, from the arm’s own runs and the scenarios "
        "(nearest: from the scenarios alone). Gain: by how many points training improved validation, mean over runs. "
        "An arm that gained little is about as it started, and no answer to what it could become."
    )
    table = Table(name="completion", caption=caption, shown=pd.DataFrame(shown), data=pd.DataFrame(data))
    return Section(title="Tasks completed", tables=(table,))


def _curves(study: Study) -> Section:
    data = pd.DataFrame(
        [
            {"arm": arm, "seed": seed, "update": update, "episodes": episodes, "percent": 100 * completion}
            for (arm, seed), curve in study.curves.items()
            for update, episodes, completion in zip(curve.updates, curve.episodes, curve.completion, strict=True)
        ]
    )
    caption = (
        "Greedy completion on each run’s own validation scenarios, drawn from its training distribution and decided "
        "under its mask rule: curves of arms that differ in these are not to be compared. Thin: runs; bold: their mean."
    )
    picture = Picture(name="learning_curves", caption=caption, figure=_draw_curves(study, data), data=data)
    return Section(title="Learning curves", pictures=(picture,))


def _draw_curves(study: Study, data: pd.DataFrame) -> Figure:
    """A panel for each question: validation completion against updates, thin for runs, bold for their mean."""
    questions = study.design.questions
    columns = min(COLUMNS, len(questions))
    lines = -(-len(questions) // columns)
    figure = new_figure(4.8 * columns, 3.5 * lines)
    panels = list(figure.subplots(lines, columns, squeeze=False).flat)
    for axes, question in zip(panels, questions, strict=False):
        plain(axes)
        axes.set_title(question.title, fontsize=10, color=INK, loc="left")
        for arm, colour in zip(question.arms, COLOURS, strict=False):
            runs = data[data["arm"] == arm].pivot(index="update", columns="seed", values="percent")
            axes.plot(runs, color=colour, linewidth=0.8, alpha=0.45)
            axes.plot(runs.mean(axis="columns"), color=colour, linewidth=2, label=arm)
        axes.legend(
            frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=4, fontsize=8, labelcolor=INK,
            handlelength=1.2, columnspacing=1.0,
        )  # fmt: skip
    for unused in panels[len(questions) :]:
        unused.remove()
    figure.supxlabel("updates", fontsize=9, color=FAINT)
    figure.supylabel("validation: tasks completed, mean %", fontsize=9, color=FAINT)
    return figure


def _mean_over(study: Study) -> str:
    numbers = [str(robots) for robots in study.design.compared]
    return f"mean over {', '.join(numbers[:-1])} and {numbers[-1]} robots"
