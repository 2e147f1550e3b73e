"""What is trained: the three ways of sharing, otherwise equal, and with the same number of decisions per network."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.budget import TrainingBudget
from mrta_zoo.eval.studies.design import Arm, Design, Question, choose
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import USUAL_KINDS, Sharing

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
        Question(name="episodes", title="equal episodes", reference=SHARED, others=(BY_CAPACITY, INDEPENDENT)),
        Question(
            name="decisions",
            title="equal decisions a network",
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

    def arm(name: str, sharing: Sharing, share: int = MOST) -> Arm:
        scenarios = budget.scenarios * share // MOST
        config = budget.config(
            network=NETWORK, sharing=sharing, scenarios=scenarios, min_robots=TRAINED_ROBOTS[0], max_robots=MOST
        )
        return Arm(name=name, config=config)

    found = (
        arm(INDEPENDENT, "independent"),
        arm(BY_CAPACITY, "by-capacity"),
        arm(BY_CAPACITY_FEWER, "by-capacity", share=kinds),
        arm(SHARED, "shared"),
        arm(SHARED_FEWER, "shared", share=1),
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
        every_arm=all_arms(budget),
        questions=choose(only, QUESTIONS),
        seeds=seeds,
        budget=budget,
        held_out=HeldOut(budget.tasks, held_out, tuple(sorted({*TRAINED_ROBOTS, *UNSEEN_ROBOTS}))),
        compared=TRAINED_ROBOTS,
        seed_by_seed=True,
    )
