"""A study as declared: which arms are trained, what is asked about them, and how much each run gets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.budget import TrainingBudget
from mrta_zoo.eval.studies.held_out import Distribution, HeldOut
from mrta_zoo.eval.studies.run import Run
from mrta_zoo.io import Case
from mrta_zoo.policies.neural.sharing import WAYS
from mrta_zoo.train.config import TrainConfig

MAX_SEEDS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """One way to train.

    Attributes:
        name: in rows, and of the runs' folders.
        title: for people.
        config: of its runs, except for the seed.
        alike: the same for arms whose runs are taken to scatter alike; by default an arm is alone.
    """

    name: str
    title: str
    config: TrainConfig
    alike: str = ""

    @property
    def kind(self) -> str:
        """What arms that scatter alike have in common."""
        return self.alike or self.name

    @property
    def networks(self) -> int:
        """How many networks are trained."""
        return WAYS[self.config.sharing].networks(self.config.max_robots, self.config.kinds)

    @property
    def episodes(self) -> int:
        """Missions that a run samples."""
        return self.config.updates * self.config.scenarios * self.config.samples

    def serves(self, robots: int) -> bool:
        """Whether it can decide for so many robots."""
        return self.config.sharing != "independent" or robots <= self.networks


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A family of comparisons: p-values are adjusted for their number within it.

    Attributes:
        name: for the flag, and in tables.
        title: for people.
        reference: the arm that the others are compared with.
        others: the arms that differ from it in one thing.
        distributions: of the held-out scenarios that count.
    """

    name: str
    title: str
    reference: str
    others: tuple[str, ...]
    distributions: tuple[Distribution, ...] = ("taptc",)

    @property
    def arms(self) -> tuple[str, ...]:
        """All of them, the reference first."""
        return (self.reference, *self.others)


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A claim that a study tests, whichever way it comes out.

    Attributes:
        name: in tables.
        says: the claim, and what is measured of it: greater than 0 if it holds.
        question: answers it; the runs of all its arms say how much runs scatter.
        coefficients: of the arms.
        weights: of the numbers of robots; by default the mean over those that are compared.
    """

    name: str
    says: str
    question: Question
    coefficients: Mapping[str, float]
    weights: Mapping[int, float] | None = None


def choose(names: Sequence[str], questions: Mapping[str, Question]) -> list[Question]:
    """The questions with these names, in the study's order.

    Raises:
        ConfigError: if there is no question of some name.
    """
    for name in names:
        if name not in questions:
            raise ConfigError(f"there is no question {name!r}; expected some of {', '.join(questions)}")
    return [question for question in questions.values() if question.name in names]


@dataclass(frozen=True, kw_only=True)
class Design:
    """Everything that is decided before a study begins.

    Attributes:
        command: of `mrta-zoo`.
        title: of the report.
        each_run: what is trained, in a sentence.
        scatter: whose runs are taken to scatter alike, in words.
        every_arm: arms by name, those whose runs take longest first; only those that a question needs are trained.
        questions: that are asked.
        seeds: runs of each arm, with seeds 0, 1, ….
        budget: of the runs.
        held_out: the scenarios that arms are compared on.
        compared: the numbers of robots whose mean counts.
        claims: that are tested, as far as their questions are asked.
        seed_by_seed: whether all arms are trained with one seed before any is with the next.
        settings: what else the manifest has to say.

    Raises:
        ConfigError: if there are no seeds, or too many.
    """

    command: str
    title: str
    each_run: str
    scatter: str
    every_arm: Mapping[str, Arm]
    questions: Sequence[Question]
    seeds: int
    budget: TrainingBudget
    held_out: HeldOut
    compared: tuple[int, ...]
    claims: Sequence[Claim] = ()
    seed_by_seed: bool = False
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not 1 <= self.seeds <= MAX_SEEDS:
            raise ConfigError(f"seeds is {self.seeds}; expected a whole number from 1 to {MAX_SEEDS}")

    @property
    def arms(self) -> dict[str, Arm]:
        """The arms that are trained, in the order of the questions."""
        return {name: self.every_arm[name] for question in self.questions for name in question.arms}

    @property
    def distributions(self) -> tuple[Distribution, ...]:
        """Of the held-out scenarios that some question needs."""
        return tuple(dict.fromkeys(each for question in self.questions for each in question.distributions))

    @property
    def all_settings(self) -> dict[str, Any]:
        """For the manifest."""
        return {
            "only": [question.name for question in self.questions], "seeds": self.seeds, **asdict(self.budget),
            **self.settings, "held_out": self.held_out.count,
        }  # fmt: skip

    def cases(self) -> list[Case]:
        """Every held-out scenario."""
        return [
            Case(scenario.name, scenario)
            for distribution in self.distributions
            for robots in self.held_out.robots
            for scenario in self.held_out.scenarios(distribution, robots)
        ]

    def runs(self, out: Path) -> list[Run]:
        """Every run, in the order in which they are begun.

        Args:
            out: folder of the study.
        """
        names, seeds = [name for name in self.every_arm if name in self.arms], range(self.seeds)
        order = [(name, seed) for seed in seeds for name in names] if self.seed_by_seed else product(names, seeds)
        return [self._run(self.every_arm[name], seed, out) for name, seed in order]

    def _run(self, arm: Arm, seed: int, out: Path) -> Run:
        asked = [question for question in self.questions if arm.name in question.arms]
        served = tuple(robots for robots in self.held_out.robots if arm.serves(robots))
        return Run(
            variant=arm.name,
            folder=out / "runs" / f"{arm.name}-seed{seed}",
            config=replace(arm.config, seed=seed),
            held_out=replace(self.held_out, robots=served),
            distributions=tuple(dict.fromkeys(each for question in asked for each in question.distributions)),
        )
