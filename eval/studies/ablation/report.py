"""The study as a report: the paper's claims, the differences, the means, the learning curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from mrta_zoo.digits import percentage
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.ablation.claims import Claim, claims_of, gap_by_robots, verdicts
from mrta_zoo.eval.studies.ablation.design import ENCODER, ROBOTS
from mrta_zoo.eval.studies.ablation.figures import draw_curves, draw_forest
from mrta_zoo.eval.studies.design import Question
from mrta_zoo.eval.studies.effects import equal_weights, run_values
from mrta_zoo.eval.studies.report import study_report
from mrta_zoo.eval.studies.study import Study
from mrta_zoo.wording import counted

INTERVALS = (
    f"{100 * LEVEL:.0f} % intervals are Student’s, from the scatter of training runs (pooled over the variants of a "
    "question with the same decoder, as in a one-way analysis of variance) and of scenarios (paired), with "
    "Satterthwaite’s degrees of freedom."
)


def ablation_report(study: Study) -> Report:
    """All of it."""
    claims, budget = claims_of(study), study.design.budget
    return study_report(
        study,
        title="Ablation study: what each part of network and training is worth",
        summary=(
            *(claim.sentence for claim in claims),
            *(_in_short(study, question) for question in study.design.questions),
        ),
        sections=(
            *([_claims(study, claims)] if claims else ()),
            _differences(study),
            _means(study),
            _curves(study),
        ),
        flags=("only", "seeds", "updates", "paper_updates", "scenarios", "samples", "tasks", "held_out"),
        each_run=(
            f"{budget.scenarios} x {budget.samples} episodes an update; {budget.updates} updates with the candidate "
            f"decoder, {_paper_updates(study)} with the paper’s (paper-decoder: {budget.updates}, as its reference); "
            f"TAPTC-like scenarios with {budget.tasks} tasks and 1 to 4 robots, mask rule feasible, objective "
            "completion, baseline samples, unless the variant says otherwise; the policy with the best validation "
            "counts"
        ),
        scores=(
            "Every plan was scored by the package’s verifier. A task counts as completed if its work is finished by "
            "its deadline. Policies decide under the mask rule that they were trained under."
        ),
    )


def _paper_updates(study: Study) -> int:
    updates: int = study.design.settings["paper_updates"]
    return updates


def _in_short(study: Study, question: Question) -> str:
    """A question's differences in one line."""
    parts = []
    for each in study.contrasts:
        if each.question is question:
            where = f" on {each.distribution} scenarios" if len(question.distributions) > 1 else ""
            difference = wording.estimate(each.effect.difference, signed=True)
            sure = "sure" if each.sure else "not sure"
            parts.append(f"{study.design.arms[each.arm].title}{where} {difference}, {sure}")
    return f"{question.title}, against {question.reference}: {'; '.join(parts)}."


def _claims(study: Study, claims: Sequence[Claim]) -> Section:
    shown = [
        {
            "claim": claim.name,
            "points": wording.estimate(claim.effect.difference, signed=True),
            "p, adjusted": wording.p_value(claim.adjusted),
            "verdict": claim.verdict,
        }
        for claim in claims
    ]
    data = [
        {"claim": claim.name, **claim.effect.difference.columns("points"), "p": claim.effect.p,
         "adjusted_p": claim.adjusted, "verdict": claim.verdict, "measured": claim.says}
        for claim in claims
    ]  # fmt: skip
    table = Table(
        name="claims",
        caption=f"{INTERVALS} P-values are adjusted for the number of claims (Holm). {verdicts(claims)}",
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    budget = study.design.budget
    text = (
        f"Networks of embedding {next(iter(study.design.arms.values())).config.network.embedding} that saw "
        f"{_paper_updates(study) * budget.scenarios * budget.samples:,} episodes with {budget.tasks} tasks, "
        f"{counted(study.design.seeds, 'run')} of each variant; the paper’s are larger and saw some 50 million "
        "episodes with 100 tasks. An answer here is one about small networks early in training.",
    )
    gap = (_gap(study),) if ENCODER in study.design.questions else ()
    return Section(title="The paper’s claims", text=text, tables=(table, *gap))


def _gap(study: Study) -> Table:
    tasks, found = study.design.budget.tasks, gap_by_robots(study)
    shown = [
        {
            "tasks a robot": f"{tasks / robots:g}",
            "robots": str(robots),
            "CapAM minus AM": wording.estimate(effect.difference, signed=True),
        }
        for robots, effect in found
    ]
    data = [
        {"tasks_a_robot": tasks / robots, "robots": robots, **effect.difference.columns("difference"), "p": effect.p}
        for robots, effect in found
    ]
    return Table(
        name="gap_by_tasks_a_robot",
        caption="CapAM minus AM, percentage points, by tasks a robot, on TAPTC-like scenarios. " + INTERVALS,
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )


def _differences(study: Study) -> Section:
    caption = (
        "Mean % of tasks completed of each variant minus that of its reference, in percentage points. "
        f"{INTERVALS} P-values are adjusted within each question (Holm), intervals are not."
    )
    shown, data = [], []
    for each in study.contrasts:
        effect = each.effect
        shown.append(
            {
                "question": each.question.title,
                "variant": each.arm,
                "held out": each.distribution,
                "difference": wording.estimate(effect.difference, signed=True),
                "p, adjusted": wording.p_value(each.adjusted),
                "degrees of freedom": wording.DASH if effect.freedom is None else f"{effect.freedom:.1f}",
            }
        )
        data.append(
            {"question": each.question.name, "held_out": each.distribution, "variant": each.arm,
             "reference": each.question.reference, **effect.difference.columns("difference"), "p": effect.p,
             "adjusted_p": each.adjusted, "runs_standard_error": effect.runs_error,
             "scenarios_standard_error": effect.scenarios_error, "degrees_of_freedom": effect.freedom,
             "runs": effect.difference.n, "note": effect.difference.note}
        )  # fmt: skip
    frame = pd.DataFrame(data)
    return Section(
        title="Differences from the reference",
        text=(
            "So few runs of a variant say little about how much its runs scatter, so that only large differences can "
            "be told: a difference that is not sure may well be there. More seeds (--seeds) narrow the intervals. "
            "Resampling the seeds in a bootstrap would give narrower intervals, and wrong ones: of two runs it sees "
            "half of the variance.",
        ),
        pictures=(Picture(name="forest", caption=caption, figure=draw_forest(study), data=frame),),
        tables=(Table(name="differences", caption=caption, shown=pd.DataFrame(shown), data=frame),),
    )


def _means(study: Study) -> Section:
    shown, data = [], []
    for name, distribution in sorted(study.runs, key=lambda key: list(study.design.arms).index(key[0])):
        runs, arm = study.runs[name, distribution], study.design.arms[name]
        overall = run_values(runs, equal_weights(ROBOTS))
        of_runs = {robots: run_values(runs, {robots: 1.0}) for robots in ROBOTS}
        shown.append(
            {"variant": name, "what": arm.title, "held out": distribution,
             **{counted(robots, "robot"): percentage(float(np.mean(of_runs[robots]))) for robots in ROBOTS},
             "all": percentage(float(np.mean(overall))), "each run": ", ".join(percentage(value) for value in overall)}
        )  # fmt: skip
        data += [
            {"variant": name, "held_out": distribution, "seed": seed,
             **{f"percent_{robots}_robots": of_runs[robots][run] for robots in ROBOTS}, "percent": overall[run],
             "updates": arm.config.updates}
            for run, seed in enumerate(sorted(runs))
        ]  # fmt: skip
    caption = (
        f"Tasks completed in time, mean %, in one greedy pass, on {study.design.held_out.count} held-out scenarios for "
        f"each number of robots; means over {counted(study.design.seeds, 'run')}. The CSV has a line for each run."
    )
    table = Table(name="completion", caption=caption, shown=pd.DataFrame(shown), data=pd.DataFrame(data))
    return Section(title="Tasks completed", tables=(table,))


def _curves(study: Study) -> Section:
    caption = (
        "Greedy completion on each run’s own validation scenarios, drawn from its training distribution and decided "
        "under its mask rule: curves of variants that differ in these are not to be compared. Thin: runs; bold: their "
        "mean."
    )
    data = pd.DataFrame(
        [
            {"variant": arm, "seed": seed, "episodes": episodes, "completion": completion}
            for (arm, seed), curve in study.curves.items()
            for episodes, completion in zip(curve.episodes, curve.completion, strict=True)
        ]
    )
    picture = Picture(name="learning_curves", caption=caption, figure=draw_curves(study, data), data=data)
    return Section(title="Learning curves", pictures=(picture,))
