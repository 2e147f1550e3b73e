"""The study as a report: the paper's claims, the differences, the means, the learning curves, how it was made."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from mrta_zoo.digits import percentage
from mrta_zoo.eval.experiment import Manifest
from mrta_zoo.eval.machine import Session
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.ablation.claims import Claim, claims_of, gap_by_robots, verdicts
from mrta_zoo.eval.studies.ablation.figures import curves_data, draw_curves, draw_forest, forest_data
from mrta_zoo.eval.studies.ablation.questions import ENCODER
from mrta_zoo.eval.studies.ablation.study import Comparison, Study
from mrta_zoo.eval.studies.ablation.variants import ROBOTS
from mrta_zoo.eval.studies.effects import arrange, equal_weights, run_values
from mrta_zoo.eval.studies.hardly import hardly_trained, warning
from mrta_zoo.eval.studies.study import command_line, trained_on
from mrta_zoo.wording import counted

INTERVALS = (
    f"{100 * LEVEL:.0f} % intervals are Student’s, from the scatter of training runs (pooled over the variants of a "
    "question with the same decoder, as in a one-way analysis of variance) and of scenarios (paired), with "
    "Satterthwaite’s degrees of freedom."
)


def make_report(study: Study, manifest: Manifest, sessions: Sequence[Session]) -> Report:
    """All of it.

    Args:
        study: the rows, and what was asked.
        manifest: of the study.
        sessions: in which runs were trained.
    """
    claims, comparisons = claims_of(study), study.comparisons()
    sections = [_differences(study, comparisons), _means(study), _curves(study)]
    if claims:
        sections.insert(0, _claims(study, claims))
    return Report(
        title="Ablation study: what each part of network and training is worth",
        summary=(
            *(claim.sentence for claim in claims),
            *(_in_short(study, question.name, comparisons) for question in study.questions),
            *warning(hardly_trained(study.variants, study.curves)),
        ),
        sections=tuple(sections),
        made=_made(study, manifest, sessions),
    )


def _in_short(study: Study, name: str, comparisons: Sequence[Comparison]) -> str:
    """A question's differences in one line."""
    found = [each for each in comparisons if each.question.name == name]
    parts = []
    for each in found:
        where = f" on {each.distribution} scenarios" if len(each.question.distributions) > 1 else ""
        sure = "sure" if each.sure else "not sure"
        difference = wording.estimate(each.effect.difference, signed=True)
        parts.append(f"{study.variants[each.variant].title}{where} {difference}, {sure}")
    return f"{found[0].question.title}, against {found[0].question.reference}: {'; '.join(parts)}."


def _claims(study: Study, claims: Sequence[Claim]) -> Section:
    lines = [
        {
            "claim": claim.name,
            "points": wording.estimate(claim.effect.difference, signed=True),
            "p, adjusted": wording.p_value(claim.adjusted),
            "verdict": claim.verdict,
        }
        for claim in claims
    ]
    data = [
        {
            "claim": claim.name,
            "points": claim.effect.difference.mean,
            "low": claim.effect.difference.low,
            "high": claim.effect.difference.high,
            "p": claim.effect.p,
            "adjusted_p": claim.adjusted,
            "verdict": claim.verdict,
            "measured": claim.says,
        }
        for claim in claims
    ]
    tables = [
        Table(
            name="claims",
            caption=f"{INTERVALS} P-values are adjusted for the number of claims (Holm). {verdicts(claims)}",
            shown=pd.DataFrame(lines),
            data=pd.DataFrame(data),
        )
    ]
    if ENCODER in study.questions:
        tables.append(_gap(study))
    budget = study.budget
    text = (
        f"Networks of embedding {next(iter(study.variants.values())).config.network.embedding} that saw "
        f"{budget.paper_updates * budget.scenarios * budget.samples:,} episodes with {budget.tasks} tasks, "
        f"{counted(study.seeds, 'run')} of each variant; the paper’s are larger and saw some 50 million "
        "episodes with 100 tasks. An answer here is one about small networks early in training.",
    )
    return Section(title="The paper’s claims", text=text, tables=tuple(tables))


def _gap(study: Study) -> Table:
    found = gap_by_robots(study)
    per_robot = {robots: f"{study.budget.tasks / robots:g}" for robots in ROBOTS}
    return Table(
        name="gap_by_tasks_a_robot",
        caption="CapAM minus AM, percentage points, by tasks a robot, on TAPTC-like scenarios. " + INTERVALS,
        shown=pd.DataFrame(
            [
                {
                    "tasks a robot": per_robot[robots],
                    "robots": str(robots),
                    "CapAM minus AM": wording.estimate(effect.difference, signed=True),
                }
                for robots, effect in found
            ]
        ),
        data=pd.DataFrame(
            [
                {
                    "tasks_a_robot": study.budget.tasks / robots,
                    "robots": robots,
                    "difference": effect.difference.mean,
                    "low": effect.difference.low,
                    "high": effect.difference.high,
                    "p": effect.p,
                }
                for robots, effect in found
            ]
        ),
    )


def _differences(study: Study, comparisons: list[Comparison]) -> Section:
    data = forest_data(comparisons)
    caption = (
        "Mean % of tasks completed of each variant minus that of its reference, in percentage points. "
        f"{INTERVALS} P-values are adjusted within each question (Holm), intervals are not."
    )
    shown = pd.DataFrame(
        [
            {
                "question": each.question.title,
                "variant": each.variant,
                "held out": each.distribution,
                "difference": wording.estimate(each.effect.difference, signed=True),
                "p, adjusted": wording.p_value(each.adjusted),
                "degrees of freedom": "–" if each.effect.freedom is None else f"{each.effect.freedom:.1f}",
            }
            for each in comparisons
        ]
    )
    return Section(
        title="Differences from the reference",
        text=(
            "So few runs of a variant say little about how much its runs scatter, so that only large differences can "
            "be told: a difference that is not sure may well be there. More seeds (--seeds) narrow the intervals. "
            "Resampling the seeds in a bootstrap would give narrower intervals, and wrong ones: of two runs it sees "
            "half of the variance.",
        ),
        pictures=(Picture(name="forest", caption=caption, figure=draw_forest(study, comparisons), data=data),),
        tables=(Table(name="differences", caption=caption, shown=shown, data=data),),
    )


def _means(study: Study) -> Section:
    found = arrange(study.rows)
    shown, data = [], []
    for name, distribution in sorted(found, key=lambda key: list(study.variants).index(key[0])):
        runs = found[name, distribution]
        overall = run_values(runs, equal_weights(ROBOTS))
        of_runs = {robots: run_values(runs, {robots: 1.0}) for robots in ROBOTS}
        by_robots = {counted(robots, "robot"): percentage(float(np.mean(of_runs[robots]))) for robots in ROBOTS}
        each_run = ", ".join(percentage(value) for value in overall)
        variant = study.variants[name]
        shown.append(
            {"variant": name, "what": variant.title, "held out": distribution, **by_robots,
             "all": percentage(float(np.mean(overall))), "each run": each_run}
        )  # fmt: skip
        data += [
            {"variant": name, "held_out": distribution, "seed": seed,
             **{f"percent_{robots}_robots": of_runs[robots][run] for robots in ROBOTS}, "percent": overall[run],
             "updates": variant.config.updates}
            for run, seed in enumerate(sorted(runs))
        ]  # fmt: skip
    count = len(study.rows) // max(1, len(data) * len(ROBOTS))
    caption = (
        f"Tasks completed in time, mean %, in one greedy pass, on {count} held-out scenarios for each number of "
        f"robots; means over {counted(study.seeds, 'run')}. The CSV has a line for each run."
    )
    table = Table(name="completion", caption=caption, shown=pd.DataFrame(shown), data=pd.DataFrame(data))
    return Section(title="Tasks completed", tables=(table,))


def _curves(study: Study) -> Section:
    caption = (
        "Greedy completion on each run’s own validation scenarios, drawn from its training distribution and decided "
        "under its mask rule: curves of variants that differ in these are not to be compared. Thin: runs; bold: their "
        "mean."
    )
    picture = Picture(name="learning_curves", caption=caption, figure=draw_curves(study), data=curves_data(study))
    return Section(title="Learning curves", pictures=(picture,))


def _made(study: Study, manifest: Manifest, sessions: Sequence[Session]) -> tuple[tuple[str, str], ...]:
    budget = study.budget
    return (
        *command_line(
            manifest, "only", "seeds", "updates", "paper_updates", "scenarios", "samples", "tasks", "held_out"
        ),
        ("Seeds", f"0 to {study.seeds - 1}, of weights, training scenarios and samples"),
        (
            "Each run",
            f"{budget.scenarios} x {budget.samples} episodes an update; {budget.updates} updates with the candidate "
            f"decoder, {budget.paper_updates} with the paper’s (paper-decoder: {budget.updates}, as its reference); "
            f"TAPTC-like scenarios with {budget.tasks} tasks and 1 to 4 robots, mask rule feasible, objective "
            "completion, baseline samples, unless the variant says otherwise; the policy with the best validation "
            "counts",
        ),
        ("Held-out scenarios", f"SHA-256 {manifest.cases}"),
        (
            "Scores",
            "Every plan was scored by the package’s verifier. A task counts as completed if its work is finished by "
            "its deadline. Policies decide under the mask rule that they were trained under.",
        ),
        *trained_on(sessions),
    )
