"""What is trained: the three ways of sharing, otherwise equal, and with the same number of decisions a network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.budget import Budget as StudyBudget
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import USUAL_KINDS, Sharing
from mrta_zoo.train.config import TrainConfig

TRAINED_ROBOTS = (2, 3, 4)
UNSEEN_ROBOTS = (1, 6, 8)
"""Numbers of robots that no run is trained on; independent networks exist only for the first of them."""
NETWORK = NetworkConfig(embedding=32, heads=4)
"""CapAM, small, so that the study takes less than half an hour on two cores."""
MOST = TRAINED_ROBOTS[-1]


@dataclass(frozen=True, kw_only=True)
class Budget(StudyBudget):
    """What all runs of the study have in common; `scenarios` is a multiple of `MOST`, to divide among the robots."""

    updates: int = 600
    scenarios: int = 12
    samples: int = 8
    tasks: int = 30
    validations: int = 20
    validation_scenarios: int = 96

    def __post_init__(self) -> None:
        if self.scenarios < 1 or self.scenarios % MOST:
            raise ConfigError(f"scenarios is {self.scenarios}; expected {MOST}, {2 * MOST}, {3 * MOST}, …")
        super().__post_init__()

    def config(self, sharing: Sharing, scenarios: int) -> TrainConfig:
        """A run with so many scenarios an update, but for its seed."""
        return self.run(
            network=NETWORK, sharing=sharing, scenarios=scenarios, min_robots=TRAINED_ROBOTS[0], max_robots=MOST
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """One way to train.

    Attributes:
        name: in rows, and of the runs' folders.
        networks: how many there are.
        config: of its runs, but for the seed.
    """

    name: str
    networks: int
    config: TrainConfig

    @property
    def episodes(self) -> int:
        """Missions that a run samples."""
        return self.config.updates * self.config.scenarios * self.config.samples

    @property
    def robots(self) -> tuple[int, ...]:
        """Numbers of robots that it can decide for, of those the study looks at."""
        every = sorted({*TRAINED_ROBOTS, *UNSEEN_ROBOTS})
        return tuple(each for each in every if self.config.sharing != "independent" or each <= MOST)


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A comparison at equal cost, in one sense or another; p-values are adjusted within it.

    Attributes:
        name: for the flag, and in tables.
        title: for people.
        arms: the names of what is compared, shared first.
    """

    name: str
    title: str
    arms: tuple[str, ...]


SHARED, BY_CAPACITY, INDEPENDENT = "shared", "by-capacity", "independent"
SHARED_FEWER, BY_CAPACITY_FEWER = "shared-fewer", "by-capacity-fewer"

QUESTIONS: dict[str, Question] = {
    question.name: question
    for question in (
        Question(name="episodes", title="equal episodes", arms=(SHARED, BY_CAPACITY, INDEPENDENT)),
        Question(
            name="decisions",
            title="equal decisions a network",
            arms=(SHARED_FEWER, BY_CAPACITY_FEWER, INDEPENDENT),
        ),
    )
}


def all_arms(budget: Budget) -> dict[str, Arm]:
    """Every arm by name.

    A decision teaches one network. With as many episodes, each of M independent networks sees 1/M of the decisions that
    a shared one sees, in the mean. To make these equal, the shared network gets 1/M of the scenarios at each update,
    and K networks by capacity K/M: as many gradient steps, each from as many decisions. Training the others on M times
    as many episodes would answer the same question at M times the cost.
    """
    kinds = len(USUAL_KINDS)

    def arm(name: str, sharing: Sharing, networks: int, of: int = 1, parts: int = 1) -> Arm:
        return Arm(name=name, networks=networks, config=budget.config(sharing, budget.scenarios * of // parts))

    found = (
        arm(INDEPENDENT, "independent", MOST),
        arm(BY_CAPACITY, "by-capacity", kinds),
        arm(BY_CAPACITY_FEWER, "by-capacity", kinds, of=kinds, parts=MOST),
        arm(SHARED, "shared", 1),
        arm(SHARED_FEWER, "shared", 1, parts=MOST),
    )
    return {each.name: each for each in found}


def needed(questions: Sequence[Question], budget: Budget) -> dict[str, Arm]:
    """The arms that these questions compare, by name, those whose runs take longest first."""
    names = {name for question in questions for name in question.arms}
    return {name: arm for name, arm in all_arms(budget).items() if name in names}
