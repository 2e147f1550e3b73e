"""The study as a report: differences, completion by number of robots, choices, costs, learning curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from mrta_zoo.digits import share
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.significance import LEVEL, Estimate, estimate_mean
from mrta_zoo.eval.studies.design import Question
from mrta_zoo.eval.studies.report import study_report
from mrta_zoo.eval.studies.sharing.choices import ACROSS, AGAIN, SCENARIOS, Unlikeness, unlikeness
from mrta_zoo.eval.studies.sharing.design import INDEPENDENT, MOST, NETWORK, TRAINED_ROBOTS
from mrta_zoo.eval.studies.sharing.figures import curves_data, draw_by_robots, draw_curves
from mrta_zoo.eval.studies.study import Study
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.verify import verify
from mrta_zoo.wording import counted

INTERVALS = (
    f"{100 * LEVEL:.0f} % intervals are Student’s, from the scatter of training runs (each arm’s own) and of scenarios "
    "(paired), with Satterthwaite’s degrees of freedom."
)
TRAINED = f"{TRAINED_ROBOTS[0]} to {TRAINED_ROBOTS[-1]} robots"


def sharing_report(study: Study) -> Report:
    """All of it."""
    choices, budget = unlikeness(study), study.design.budget
    return study_report(
        study,
        title="Should robots share one policy?",
        summary=(
            *(_in_short(study, question) for question in study.design.questions),
            *_unseen(study),
            *_choices_in_short(choices),
        ),
        sections=(
            _differences(study),
            _by_robots(study),
            *([_choices(choices)] if choices else ()),
            _costs(study),
            _curves(study),
        ),
        flags=("only", "seeds", "updates", "scenarios", "samples", "tasks", "held_out"),
        each_run=(
            f"CapAM with embedding {NETWORK.embedding} and {NETWORK.heads} heads; plain REINFORCE, nothing to "
            f"imitate; {budget.updates} updates; TAPTC-like scenarios with {budget.tasks} tasks and "
            f"{TRAINED}, the first half of them (rounded down) of capacity 2, the others of 1; mask rule feasible, "
            "objective completion, baseline samples; the policy with the best validation counts"
        ),
        scores="Every plan, made in one greedy pass, was scored by the package’s verifier.",
    )


def _in_short(study: Study, question: Question) -> str:
    """A question's answer in a line."""
    parts = []
    for each in study.contrasts:
        if each.question is question:
            p = f", adjusted p {wording.equals(wording.p_value(each.adjusted))}, {'sure' if each.sure else 'not sure'}"
            difference = wording.estimate(each.effect.difference, signed=True)
            parts.append(f"{each.arm} {difference} points{p if each.adjusted is not None else ''}")
    shared = question.reference
    return (
        f"At {question.title}, {TRAINED}: {shared} completes "
        f"{wording.percentage(study.mean(shared, TRAINED_ROBOTS))} %; against it {'; '.join(parts)}."
    )


def _unseen(study: Study) -> list[str]:
    """What becomes of numbers of robots that were never trained on."""
    parts = []
    for name in study.design.questions[0].arms:
        of = ", ".join(
            f"{wording.number(study.mean(name, [robots]).mean)} % with {robots}"
            for robots in _served(study, name)
            if robots not in TRAINED_ROBOTS
        )
        parts.append(f"{name} {of}")
    found = [f"Numbers of robots never trained on: {'; '.join(parts)}."]
    if refusal := refusal_of(study, INDEPENDENT):
        found.append(
            f"Asked to plan for {counted(refusal[0], 'robot')}, {INDEPENDENT} networks refuse: “{refusal[1]}”."
        )
    return found


def refusal_of(study: Study, arm: str) -> tuple[int, str] | None:
    """The fewest robots that an arm has no policy for, and what it says then; None if it serves them all."""
    beyond = [robots for robots in study.design.held_out.robots if robots not in _served(study, arm)]
    if not beyond:
        return None
    try:
        study.policies[arm, 0].solve(study.design.held_out.scenarios("taptc", beyond[0])[0])
    except ConfigError as error:
        return beyond[0], str(error)
    raise AssertionError(f"{arm} serves {beyond[0]} robots")


def _served(study: Study, arm: str) -> list[int]:
    """The numbers of robots that an arm can decide for."""
    return [robots for robots in study.design.held_out.robots if study.design.arms[arm].serves(robots)]


def _choices_in_short(choices: Sequence[Unlikeness]) -> list[str]:
    by = {(each.arm, each.pairs): each for each in choices}
    across, again = by.get((INDEPENDENT, ACROSS)), by.get((INDEPENDENT, AGAIN))
    parts = [f"those of two robots trained together differ by {_bits(across)}"] if across else []
    if again:
        parts.append(f"those of the same robot trained with two seeds by {_bits(again)}")
    parts += [
        f"those of two runs of {each.arm} by {_bits(each)}"
        for each in choices
        if each.pairs == AGAIN and each.arm.startswith("shared")
    ]
    return [f"Choices of independent networks, asked the same: {'; '.join(parts)}."] if across else []


def _bits(each: Unlikeness) -> str:
    return f"{each.divergence:.2f} bits (other likeliest task in {share(each.disagreement)} % of decisions)"


def _differences(study: Study) -> Section:
    shown, data = [], []
    for each in study.contrasts:
        difference, shared = each.effect.difference, each.question.reference
        by_robots = {
            robots: study.effect({each.arm: 1.0, shared: -1.0}, {robots: 1.0}).difference
            for robots in _served(study, each.arm)
        }
        cells = {robots: wording.number(value.mean, signed=True) for robots, value in by_robots.items()}
        shown.append(
            {
                "at": each.question.title,
                "difference": f"{each.arm} − {shared}",
                TRAINED: wording.estimate(difference, signed=True),
                "p, adjusted": wording.p_value(each.adjusted),
                **{counted(n, "robot"): cells.get(n, wording.DASH) for n in study.design.held_out.robots},
            }
        )
        label = f"{TRAINED_ROBOTS[0]}-{TRAINED_ROBOTS[-1]}"
        which = {"question": each.question.name, "arm": each.arm, "reference": shared}
        data += [
            {**which, "robots": label, **difference.columns("difference"), "p": each.effect.p,
             "adjusted_p": each.adjusted},
            *({**which, "robots": str(n), **value.columns("difference")} for n, value in by_robots.items()),
        ]  # fmt: skip
    table = Table(
        name="differences",
        caption=(
            f"Mean % of tasks completed of each way of sharing minus that of the shared network, percentage points; "
            f"then the same by number of robots, whose intervals are in the CSV. {INTERVALS} P-values are adjusted "
            "within each question (Holm), intervals are not."
        ),
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    text = (
        "Equal episodes: all see the same missions; a shared network learns from every decision of every robot, one "
        f"of {MOST} independent ones from those of its robot. Equal decisions a network: “fewer” networks get so many "
        f"fewer scenarios at each update, 1/{MOST} for the shared one, that each network takes as many steps as an "
        "independent one, from as many decisions (mean over networks). They come from fewer missions, though, and a "
        "mission has one outcome, whoever decides in it: at equal decisions a shared network learns from fewer "
        "outcomes.",
    )
    return Section(title="Differences", text=text, tables=(table,))


def _by_robots(study: Study) -> Section:
    shown, data = [], []
    for name in (*study.design.arms, "nearest"):
        means = (
            {robots: study.mean(name, [robots]) for robots in _served(study, name)}
            if name in study.design.arms
            else {robots: nearest(study, robots) for robots in study.design.held_out.robots}
        )
        shown.append(
            {
                "": name,
                **{
                    counted(robots, "robot"): wording.percentage(means[robots]) if robots in means else "no network"
                    for robots in study.design.held_out.robots
                },
            }
        )
        data += [
            {"arm": name, "robots": robots, "trained": robots in TRAINED_ROBOTS, **value.columns("percent")}
            for robots, value in means.items()
        ]
    caption = (
        f"Tasks completed in time, mean %, on {study.design.held_out.count} held-out scenarios for each number of "
        f"robots; {TRAINED} were trained on. {INTERVALS} Nearest: the nearest feasible task, whose intervals come from "
        "scenarios alone."
    )
    frame = pd.DataFrame(data)
    return Section(
        title="Tasks completed by number of robots",
        pictures=(Picture(name="by_robots", caption=caption, figure=draw_by_robots(study, frame), data=frame),),
        tables=(Table(name="completion", caption=caption, shown=pd.DataFrame(shown), data=frame),),
    )


def nearest(study: Study, robots: int) -> Estimate:
    """% completed by the nearest-feasible rule, with an interval that knows of scenarios."""
    solver, scenarios = make_solver("nearest"), study.design.held_out.scenarios("taptc", robots)
    return estimate_mean([100 * verify(each, solver.solve(each)).completed / each.num_tasks for each in scenarios], 0)


def _choices(choices: Sequence[Unlikeness]) -> Section:
    shown = [
        {
            "": each.arm,
            "compared": each.pairs,
            "pairs": str(each.count),
            "divergence, bits": f"{each.divergence:.3f} ({each.least:.3f} to {each.most:.3f})",
            "other likeliest task": f"{share(each.disagreement)} %",
        }
        for each in choices
    ]
    decisions = choices[0].decisions
    table = Table(
        name="choices",
        caption=(
            f"Jensen-Shannon divergence of two networks’ probabilities, 0 to 1 bit, mean over {decisions:,} decisions "
            "and over pairs (least and greatest of a pair), and how often their likeliest tasks differ. All networks "
            "were asked about the same moments, of missions that the nearest-feasible rule drives through the first "
            f"{SCENARIOS} held-out scenarios of each number of robots, if at least two tasks could be chosen."
        ),
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(
            [
                {"arm": each.arm, "compared": each.pairs, "pairs": each.count, "decisions": each.decisions,
                 "divergence_bits": each.divergence, "least": each.least, "most": each.most,
                 "disagreement": each.disagreement}
                for each in choices
            ]
        ),
    )  # fmt: skip
    text = (
        "Whether independent robots have found roles of their own shows in this: if two robots trained together differ "
        "no more than one robot does from itself when trained with another seed, what sets them apart is chance.",
    )
    return Section(title="How differently they choose", text=text, tables=(table,))


def _costs(study: Study) -> Section:
    shown, data = [], []
    for name, arm in study.design.arms.items():
        parameters, decisions, seconds = study.parameters(name), decisions_of(study, name), study.seconds(name)
        data.append(
            {"arm": name, "networks": arm.networks, "parameters": parameters,
             "scenarios_an_update": arm.config.scenarios, "episodes": arm.episodes, "decisions_a_network": decisions,
             "seconds": seconds}
        )  # fmt: skip
        shown.append(
            {"": name, "networks": str(arm.networks), "parameters": f"{parameters:,}",
             "scenarios an update": str(arm.config.scenarios), "episodes": f"{arm.episodes:,}",
             "decisions a network": f"{decisions:,.0f}", "seconds a run": f"{seconds:,.0f}"}
        )  # fmt: skip
    busy = ", on a machine that was busy with other work" if any(machine.busy for machine in study.machines) else ""
    table = Table(
        name="costs",
        caption=(
            "Parameters of all networks together; decisions that each network learned from, mean over networks, "
            "reckoned from the tasks that missions of the finished policy complete; wall-clock time of a run, mean "
            f"over runs, one CPU thread each{busy}."
        ),
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    return Section(title="What it costs", tables=(table,))


def decisions_of(study: Study, name: str) -> float:
    """About how many decisions each network of an arm learned from, mean over its networks.

    Under the mask rule "feasible" a decision is a completed task, so that a mission has as many as it completes.
    """
    arm = study.design.arms[name]
    percent = float(np.mean([study.mean(name, [robots]).mean for robots in TRAINED_ROBOTS]))
    a_mission = study.design.budget.tasks * percent / 100
    return arm.episodes * a_mission / arm.networks


def _curves(study: Study) -> Section:
    data = curves_data(study)
    caption = (
        "Greedy completion on each run’s own validation scenarios, which runs of equal seeds share. Thin: runs; bold: "
        f"the mean over {counted(study.design.seeds, 'run')}; bands: Student’s {100 * LEVEL:.0f} % interval of that "
        "mean, other validation scenarios for other seeds included. At equal episodes: against the episodes sampled; "
        "at equal decisions a network: against the episodes sampled over the number of networks that share their "
        "decisions."
    )
    picture = Picture(name="learning_curves", caption=caption, figure=draw_curves(study, data), data=data)
    return Section(title="Learning curves", pictures=(picture,))
