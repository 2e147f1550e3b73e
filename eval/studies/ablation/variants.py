"""What is trained: a reference, and variants of it that differ in one thing each."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.budget import Budget as StudyBudget
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.train.config import TrainConfig

REFERENCE, CAPAM = "reference", "capam"
"""The two variants that others are compared with: with the candidate decoder, and with the paper's."""

ROBOTS = (1, 2, 4)
"""Of the held-out scenarios, from the most tasks a robot to the fewest."""
PLUS_NETWORK = NetworkConfig(
    embedding=32, heads=4, moments=3, decoder="candidates", decision_layers=1, candidates=8, peers=4
)
"""Small, so that dozens of runs take an hour or so on two cores."""
PAPER_NETWORK = replace(PLUS_NETWORK, decoder="attention")


@dataclass(frozen=True, kw_only=True)
class Budget(StudyBudget):
    """What all runs of the study have in common; `updates` is for runs with the candidate decoder.

    Attributes:
        paper_updates: gradient steps of runs with the paper's decoder, which take about a fifth of the time each.
    """

    updates: int = 120
    paper_updates: int = 600
    scenarios: int = 8
    samples: int = 8
    tasks: int = 50
    validations: int = 10
    validation_scenarios: int = 48

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.paper_updates < 1:
            raise ConfigError(f"paper_updates is {self.paper_updates}; expected a whole number >= 1")

    def config(self, network: NetworkConfig, updates: int) -> TrainConfig:
        """The run of the reference, or of CapAM."""
        return self.run(network=network, updates=updates, min_robots=ROBOTS[0], max_robots=ROBOTS[-1])


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One way to train.

    Attributes:
        name: in rows, and of the runs' folders.
        title: for people: what is different.
        config: of its runs, but for the seed.
    """

    name: str
    title: str
    config: TrainConfig


def all_variants(budget: Budget) -> dict[str, Variant]:
    """Every variant by name, those whose runs take longest first."""
    plus = budget.config(PLUS_NETWORK, budget.updates)
    paper = budget.config(PAPER_NETWORK, budget.paper_updates)

    def other_network(config: TrainConfig, **changes: object) -> TrainConfig:
        return replace(config, network=replace(config.network, **changes))  # type: ignore[arg-type]

    found = (
        Variant(name="unvisited", title="mask rule unvisited", config=replace(plus, mask_rule="unvisited")),
        Variant(name="rollout", title="baseline rollout", config=replace(plus, baseline="rollout")),
        Variant(name="active", title="mask rule active", config=replace(plus, mask_rule="active")),
        Variant(name=REFERENCE, title="reference: candidate decoder, capsules with P = 3", config=plus),
        Variant(name="plus-am", title="attention encoder", config=other_network(plus, encoder="attention")),
        Variant(name="plus-none", title="no encoder", config=other_network(plus, encoder="none")),
        Variant(name="exponential", title="baseline exponential", config=replace(plus, baseline="exponential")),
        Variant(name="uniform", title="trained on uniform", config=replace(plus, generator="uniform")),
        Variant(name="mixture", title="trained on mixture", config=replace(plus, generator="mixture")),
        Variant(
            name="no-layers",
            title="no decision layers: each task scored by itself",
            config=other_network(plus, decision_layers=0),
        ),
        Variant(name=CAPAM, title="CapAM (P = 3)", config=paper),
        Variant(name="capam-p2", title="CapAM, P = 2", config=other_network(paper, moments=2)),
        Variant(name="capam-p1", title="CapAM, P = 1", config=other_network(paper, moments=1)),
        Variant(name="am-1", title="attention encoder, 1 layer", config=other_network(paper, encoder="attention")),
        Variant(
            name="am",
            title="AM: attention encoder, 3 layers as in the paper",
            config=other_network(paper, encoder="attention", layers=3),
        ),
        Variant(name="capam-none", title="no encoder", config=other_network(paper, encoder="none")),
        Variant(
            name="paper-decoder",
            title="the paper’s decoder: no decision-time features",
            config=budget.config(PAPER_NETWORK, budget.updates),
        ),
    )
    return {variant.name: variant for variant in found}
