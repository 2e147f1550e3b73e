"""The study as a report: differences, completion by number of robots, choices, costs, learning curves."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from mrta_zoo.digits import share
from mrta_zoo.eval.experiment import Manifest
from mrta_zoo.eval.machine import Session
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.hardly import hardly_trained, warning
from mrta_zoo.eval.studies.sharing.arms import INDEPENDENT, MOST, NETWORK, TRAINED_ROBOTS
from mrta_zoo.eval.studies.sharing.choices import ACROSS, AGAIN, SCENARIOS, Unlikeness, unlikeness
from mrta_zoo.eval.studies.sharing.figures import curves_data, draw_by_robots, draw_curves
from mrta_zoo.eval.studies.sharing.study import Comparison, Study
from mrta_zoo.eval.studies.study import command_line, trained_on
from mrta_zoo.wording import counted

INTERVALS = (
    f"{100 * LEVEL:.0f} % intervals are Student’s, from the scatter of training runs (each arm’s own) and of scenarios "
    "(paired), with Satterthwaite’s degrees of freedom."
)
TRAINED = f"{TRAINED_ROBOTS[0]} to {TRAINED_ROBOTS[-1]} robots"


def make_report(study: Study, manifest: Manifest, sessions: Sequence[Session]) -> Report:
    """All of it.

    Args:
        study: the rows, and what was asked.
        manifest: of the study.
        sessions: in which runs were trained.
    """
    comparisons, choices = study.comparisons(), unlikeness(study)
    return Report(
        title="Should robots share one policy?",
        summary=(
            *(_in_short(study, question.name, comparisons) for question in study.questions),
            *_unseen(study),
            *_choices_in_short(choices),
            *warning(hardly_trained(study.arms, study.curves)),
        ),
        sections=(
            _differences(study, comparisons),
            _by_robots(study),
            *([_choices(choices)] if choices else ()),
            _costs(study, sessions),
            _curves(study),
        ),
        made=(
            *command_line(manifest, "only", "seeds", "updates", "scenarios", "samples", "tasks", "held_out"),
            ("Seeds", f"0 to {study.seeds - 1}, of weights, training scenarios and samples"),
            (
                "Each run",
                f"CapAM with embedding {NETWORK.embedding} and {NETWORK.heads} heads; plain REINFORCE, nothing to "
                f"imitate; {study.budget.updates} updates; TAPTC-like scenarios with {study.budget.tasks} tasks and "
                f"{TRAINED}, the first half of them (rounded down) of capacity 2, the others of 1; mask rule feasible, "
                "objective completion, baseline samples; the policy with the best validation counts",
            ),
            ("Held-out scenarios", f"SHA-256 {manifest.cases}"),
            ("Scores", "Every plan, made in one greedy pass, was scored by the package’s verifier."),
            *trained_on(sessions),
        ),
    )


def _in_short(study: Study, name: str, comparisons: Sequence[Comparison]) -> str:
    """A question's answer in a line."""
    found = [each for each in comparisons if each.question.name == name]
    shared = found[0].question.arms[0]
    parts = [
        f"{each.arm} {wording.estimate(each.effect.difference, signed=True)} points"
        + (f", adjusted p {_equals(wording.p_value(each.adjusted))}, {'sure' if each.sure else 'not sure'}"
           if each.adjusted is not None else "")
        for each in found
    ]  # fmt: skip
    return (
        f"At {found[0].question.title}, {TRAINED}: {shared} completes "
        f"{wording.percentage(study.mean(shared, TRAINED_ROBOTS))} %; against it {'; '.join(parts)}."
    )


def _unseen(study: Study) -> list[str]:
    """What becomes of numbers of robots that were never trained on."""
    unseen = [robots for robots in study.held_out.robots if robots not in TRAINED_ROBOTS]
    first = study.questions[0]
    parts = []
    for name in first.arms:
        served = [robots for robots in unseen if robots in study.arms[name].robots]
        of = ", ".join(f"{wording.number(study.mean(name, [robots]).mean)} % with {robots}" for robots in served)
        parts.append(f"{name} {of}")
    found = [f"Numbers of robots never trained on: {'; '.join(parts)}."]
    refusal = study.refusal(INDEPENDENT)
    if refusal is not None:
        found.append(
            f"Asked to plan for {counted(refusal[0], 'robot')}, {INDEPENDENT} networks refuse: “{refusal[1]}”."
        )
    return found


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


def _differences(study: Study, comparisons: Sequence[Comparison]) -> Section:
    shown, data = [], []
    for each in comparisons:
        difference, shared = each.effect.difference, each.question.arms[0]
        shown.append(
            {
                "at": each.question.title,
                "difference": f"{each.arm} − {shared}",
                TRAINED: wording.estimate(difference, signed=True),
                "p, adjusted": wording.p_value(each.adjusted),
                **{
                    counted(robots, "robot"): wording.number(each.by_robots[robots].mean, signed=True)
                    if robots in each.by_robots
                    else wording.DASH
                    for robots in study.held_out.robots
                },
            }
        )
        data += [
            {"question": each.question.name, "arm": each.arm, "reference": shared, "robots": label,
             "difference": value.mean, "low": value.low, "high": value.high, "p": p, "adjusted_p": adjusted}
            for label, value, p, adjusted in (
                (f"{TRAINED_ROBOTS[0]}-{TRAINED_ROBOTS[-1]}", difference, each.effect.p, each.adjusted),
                *((str(robots), value, None, None) for robots, value in each.by_robots.items()),
            )
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
    for name in (*study.arms, "nearest"):
        robots_of = study.arms[name].robots if name in study.arms else study.held_out.robots
        means = {
            robots: study.mean(name, [robots]) if name in study.arms else study.nearest(robots) for robots in robots_of
        }
        shown.append(
            {
                "": name,
                **{
                    counted(robots, "robot"): wording.percentage(means[robots]) if robots in means else "no network"
                    for robots in study.held_out.robots
                },
            }
        )
        data += [
            {"arm": name, "robots": robots, "trained": robots in TRAINED_ROBOTS, "percent": value.mean,
             "low": value.low, "high": value.high}
            for robots, value in means.items()
        ]  # fmt: skip
    caption = (
        f"Tasks completed in time, mean %, on {study.held_out.count} held-out scenarios for each number of robots; "
        f"{TRAINED} were trained on. {INTERVALS} Nearest: the nearest feasible task, whose intervals come from "
        "scenarios alone."
    )
    frame = pd.DataFrame(data)
    return Section(
        title="Tasks completed by number of robots",
        pictures=(Picture(name="by_robots", caption=caption, figure=draw_by_robots(study, frame), data=frame),),
        tables=(Table(name="completion", caption=caption, shown=pd.DataFrame(shown), data=frame),),
    )


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
                {
                    "arm": each.arm,
                    "compared": each.pairs,
                    "pairs": each.count,
                    "decisions": each.decisions,
                    "divergence_bits": each.divergence,
                    "least": each.least,
                    "most": each.most,
                    "disagreement": each.disagreement,
                }
                for each in choices
            ]
        ),
    )
    text = (
        "Whether independent robots have found roles of their own shows in this: if two robots trained together differ "
        "no more than one robot does from itself when trained with another seed, what sets them apart is chance.",
    )
    return Section(title="How differently they choose", text=text, tables=(table,))


def _costs(study: Study, sessions: Sequence[Session]) -> Section:
    shown, data = [], []
    for name, arm in study.arms.items():
        line = {
            "arm": name,
            "networks": arm.networks,
            "parameters": study.parameters(name),
            "scenarios_an_update": arm.config.scenarios,
            "episodes": arm.episodes,
            "decisions_a_network": study.decisions(name),
            "seconds": study.seconds(name),
        }
        data.append(line)
        shown.append(
            {
                "": name,
                "networks": str(arm.networks),
                "parameters": f"{line['parameters']:,}",
                "scenarios an update": str(arm.config.scenarios),
                "episodes": f"{arm.episodes:,}",
                "decisions a network": f"{line['decisions_a_network']:,.0f}",
                "seconds a run": f"{line['seconds']:,.0f}",
            }
        )
    table = Table(
        name="costs",
        caption=(
            "Parameters of all networks together; decisions that each network learned from, mean over networks, "
            "reckoned from the tasks that missions of the finished policy complete; wall-clock time of a run, mean "
            "over runs, one CPU thread each"
            + (", on a machine that was busy with other work." if any(session.busy for session in sessions) else ".")
        ),
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )
    return Section(title="What it costs", tables=(table,))


def _curves(study: Study) -> Section:
    data = curves_data(study)
    caption = (
        "Greedy completion on each run’s own validation scenarios, which runs of equal seeds share. Thin: runs; bold: "
        f"the mean over {counted(study.seeds, 'run')}; bands: Student’s {100 * LEVEL:.0f} % interval of that "
        "mean, other validation scenarios for other seeds included. At equal episodes: against the episodes sampled; "
        "at equal decisions a network: against the episodes sampled over the number of networks that share their "
        "decisions."
    )
    picture = Picture(name="learning_curves", caption=caption, figure=draw_curves(study, data), data=data)
    return Section(title="Learning curves", pictures=(picture,))


def _equals(p: str) -> str:
    return p if p.startswith("<") else f"= {p}"
