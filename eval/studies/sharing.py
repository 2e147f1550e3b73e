"""``mrta-zoo sharing``: should robots share one policy? The three ways, otherwise equal, and what each costs."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.report.parts import Report, Section, Table
from mrta_zoo.eval.studies.budget import TrainingBudget
from mrta_zoo.eval.studies.choices import choices_section, unlikeness
from mrta_zoo.eval.studies.design import Arm, Design, Question, choose
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.eval.studies.report import study_report
from mrta_zoo.eval.studies.study import Study
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import USUAL_KINDS, Sharing, build_network
from mrta_zoo.train.config import TrainConfig

TRAINED_ROBOTS = (2, 3, 4)
UNSEEN_ROBOTS = (1, 6, 8)
"""Numbers of robots that no run is trained on; independent networks exist only for the first of them."""
NETWORK = NetworkConfig(embedding=32, heads=4)
"""CapAM, small, so that the study takes less than half an hour on two cores."""
MOST = TRAINED_ROBOTS[-1]

USUAL = TrainingBudget(updates=600, scenarios=12, samples=8, tasks=30, validations=20, validation_scenarios=96)

SHARED, BY_CAPACITY, INDEPENDENT = "shared", "by-capacity", "independent"
SHARED_FEWER, BY_CAPACITY_FEWER = "shared-fewer", "by-capacity-fewer"

QUESTIONS: dict[str, Question] = {
    question.name: question
    for question in (
        Question(name="episodes", title="Equal episodes", reference=SHARED, others=(BY_CAPACITY, INDEPENDENT)),
        Question(
            name="decisions",
            title="Equal decisions per network",
            reference=SHARED_FEWER,
            others=(BY_CAPACITY_FEWER, INDEPENDENT),
        ),
    )
}


def all_arms(budget: TrainingBudget) -> dict[str, Arm]:
    """Every arm by name, those whose runs take longest first.

    A decision teaches one network. With as many episodes, each of M independent networks sees 1/M of the decisions that
    a shared one sees, on average. To make these equal, the shared network gets 1/M of the scenarios at each update,
    and K networks by capacity K/M: as many gradient steps, each from as many decisions. Training the others on M times
    as many episodes would answer the same question at M times the cost.

    An arm's runs scatter in their own way, as arms learn at different speeds. Simulated with three seeds, 94 to 96 of
    100 such intervals hold the true difference, also where one arm scatters three times as much as the other; with the
    scatter pooled over arms it would be 88 then. With two seeds it is 93.

    Raises:
        ConfigError: if the scenarios cannot be divided among `MOST` robots.
    """
    if budget.scenarios % MOST:
        raise ConfigError(f"scenarios is {budget.scenarios}; expected {MOST}, {2 * MOST}, {3 * MOST}, …")
    kinds = len(USUAL_KINDS)

    def arm(name: str, title: str, sharing: Sharing, share: int = MOST) -> Arm:
        scenarios = budget.scenarios * share // MOST
        config = budget.config(
            network=NETWORK, sharing=sharing, scenarios=scenarios, min_robots=TRAINED_ROBOTS[0], max_robots=MOST
        )
        return Arm(name=name, title=title, config=config)

    found = (
        arm(INDEPENDENT, "a network for each robot", "independent"),
        arm(BY_CAPACITY, "a network for each capacity", "by-capacity"),
        arm(
            BY_CAPACITY_FEWER,
            f"a network for each capacity, {kinds}/{MOST} of the missions",
            "by-capacity",
            share=kinds,
        ),
        arm(SHARED, "one network", "shared"),
        arm(SHARED_FEWER, f"one network, 1/{MOST} of the missions", "shared", share=1),
    )
    return {each.name: each for each in found}


def sharing(only: Sequence[str], seeds: int, budget: TrainingBudget, held_out: int) -> Design:
    """The study with these questions, see the flags of `mrta-zoo sharing`.

    Its scenarios are TAPTC-like: their robots are of two kinds, and there are both in every team that is trained on.

    Raises:
        ConfigError: if a value is out of range, or there is no such question.
    """
    return Design(
        command="sharing",
        title="Should robots share one policy?",
        each_run=(
            f"CapAM with embedding {NETWORK.embedding} and {NETWORK.heads} heads, plain REINFORCE, {budget.updates} "
            f"updates; {TRAINED_ROBOTS[0]} to {MOST} robots, the first half of them (rounded down) of capacity 2, the "
            "others of 1"
        ),
        scatter="each arm’s own",
        every_arm=all_arms(budget),
        questions=choose(only, QUESTIONS),
        seeds=seeds,
        budget=budget,
        held_out=HeldOut(budget.tasks, held_out, tuple(sorted({*TRAINED_ROBOTS, *UNSEEN_ROBOTS}))),
        compared=TRAINED_ROBOTS,
        seed_by_seed=True,
    )


def sharing_report(study: Study) -> Report:
    """The study as a report, with how differently networks choose, and what they cost."""
    choices = choices_section(unlikeness(study))
    return study_report(study, own=(*choices, _costs(study)))


def parameters(config: TrainConfig) -> int:
    """Weights of all networks together."""
    network = build_network(config.network, config.sharing, config.max_robots, 0, config.kinds)
    return sum(parameter.numel() for parameter in network.parameters())


def _costs(study: Study) -> Section:
    data = pd.DataFrame(
        [
            {"arm": name, "networks": arm.networks, "parameters": parameters(arm.config), "episodes": arm.episodes,
             "episodes per network": arm.episodes / arm.networks, "seconds per run": study.seconds(name)}
            for name, arm in study.design.arms.items()
        ]
    )  # fmt: skip
    busy = ", on a machine that was busy with other work" if any(machine.busy for machine in study.machines) else ""
    caption = (
        "Parameters of all networks together; missions that a run samples, and the same divided by the networks that "
        f"share their decisions; wall-clock time of a run, mean over runs, one CPU thread each{busy}."
    )
    numbers = data.drop(columns="arm").map("{:,.0f}".format)
    table = Table(name="costs", caption=caption, shown=numbers.assign(arm=data["arm"])[data.columns], data=data)
    text = (
        "At equal episodes all see the same missions: a shared network learns from every decision of every robot, one "
        f"of {MOST} independent ones from those of its robot. At equal decisions per network, the “fewer” networks get "
        "so many fewer scenarios per update that each takes as many steps as an independent one, from as many "
        "decisions (mean over networks), but fewer missions, and so fewer outcomes to learn from.",
    )
    return Section(title="What it costs", text=text, tables=(table,))
