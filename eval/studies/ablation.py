"""``mrta-zoo ablate``: variants that differ in one thing each, and whether the paper's claims about CapAM show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.budget import TrainingBudget
from mrta_zoo.eval.studies.design import Arm, Claim, Design, Question, choose
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.train.config import TrainConfig

REFERENCE, CAPAM = "reference", "capam"
"""The two arms that others are compared with: with the candidate decoder, and with the paper's."""

ROBOTS = (1, 2, 4)
"""Of the held-out scenarios, from the most tasks per robot to the fewest."""
PLUS_NETWORK = NetworkConfig(
    embedding=32, heads=4, moments=3, decoder="candidates", decision_layers=1, candidates=8, peers=4
)
"""Small, so that dozens of runs take an hour or so on two cores."""
PAPER_NETWORK = replace(PLUS_NETWORK, decoder="attention")

USUAL = TrainingBudget(updates=120, scenarios=8, samples=8, tasks=50, validations=10, validation_scenarios=48)
"""Its updates are for runs with the candidate decoder."""
PAPER_UPDATES = 600
"""Updates of runs with the paper's decoder, which take about a fifth of the time each."""

ENCODER = Question(
    name="encoder", title="Encoder, with the paper’s decoder", reference=CAPAM, others=("am-1", "am", "capam-none")
)
MOMENTS = Question(
    name="moments", title="P, with the paper’s decoder", reference=CAPAM, others=("capam-p2", "capam-p1")
)
QUESTIONS: dict[str, Question] = {
    question.name: question
    for question in (
        ENCODER,
        MOMENTS,
        Question(
            name="plus-encoder",
            title="Encoder, with the candidate decoder",
            reference=REFERENCE,
            others=("plus-am", "plus-none"),
        ),
        Question(name="decoder", title="Decoder", reference=REFERENCE, others=("paper-decoder", "no-layers")),
        Question(name="baseline", title="Baseline", reference=REFERENCE, others=("rollout", "exponential")),
        Question(name="mask-rule", title="Mask rule", reference=REFERENCE, others=("active", "unvisited")),
        Question(
            name="distribution",
            title="Training distribution",
            reference=REFERENCE,
            others=("uniform", "mixture"),
            distributions=("taptc", "uniform"),
        ),
    )
}

ADVANTAGE = {CAPAM: 1.0, "am": -1.0}
CLAIMS = (
    Claim(
        name="CapAM over AM",
        says="Paper: with 100 tasks CapAM completes 3 to 13.5 points more than AM. Here: capam minus am.",
        question=ENCODER,
        coefficients=ADVANTAGE,
    ),
    Claim(
        name="P ≥ 2 over P = 1",
        says="Paper: P = 1 is slightly poorer than P = 2 and 3, which hardly differ. Here: the mean of P = 2 and 3, "
        "minus P = 1.",
        question=MOMENTS,
        coefficients={CAPAM: 0.5, "capam-p2": 0.5, "capam-p1": -1.0},
    ),
    Claim(
        name="The gap grows with tasks per robot",
        says="Paper: CapAM is furthest ahead of AM where there are many tasks per robot. Here: capam minus am with "
        f"{ROBOTS[0]} robot, minus the same with {ROBOTS[-1]}.",
        question=ENCODER,
        coefficients=ADVANTAGE,
        weights={ROBOTS[0]: 1.0, ROBOTS[-1]: -1.0},
    ),
)


def all_arms(budget: TrainingBudget, paper_updates: int) -> dict[str, Arm]:
    """Every arm by name, those whose runs take longest first. Runs with the same decoder scatter alike.

    Raises:
        ConfigError: if `paper_updates` is not positive.
    """
    if paper_updates < 1:
        raise ConfigError(f"paper_updates is {paper_updates}; expected a whole number >= 1")
    robots = {"min_robots": ROBOTS[0], "max_robots": ROBOTS[-1]}
    plus = budget.config(network=PLUS_NETWORK, **robots)
    paper = budget.config(network=PAPER_NETWORK, updates=paper_updates, **robots)
    short = budget.config(network=PAPER_NETWORK, **robots)

    def arm(name: str, title: str, config: TrainConfig, **network: Any) -> Arm:
        config = replace(config, network=replace(config.network, **network))
        return Arm(name=name, title=title, config=config, alike=config.network.decoder)

    found = (
        arm("unvisited", "mask rule unvisited", replace(plus, mask_rule="unvisited")),
        arm("rollout", "baseline rollout", replace(plus, baseline="rollout")),
        arm("active", "mask rule active", replace(plus, mask_rule="active")),
        arm(REFERENCE, "reference: candidate decoder, capsules with P = 3", plus),
        arm("plus-am", "attention encoder", plus, encoder="attention"),
        arm("plus-none", "no encoder", plus, encoder="none"),
        arm("exponential", "baseline exponential", replace(plus, baseline="exponential")),
        arm("uniform", "trained on uniform", replace(plus, generator="uniform")),
        arm("mixture", "trained on mixture", replace(plus, generator="mixture")),
        arm("no-layers", "no decision layers: each task scored by itself", plus, decision_layers=0),
        arm(CAPAM, "CapAM (P = 3)", paper),
        arm("capam-p2", "CapAM, P = 2", paper, moments=2),
        arm("capam-p1", "CapAM, P = 1", paper, moments=1),
        arm("am-1", "attention encoder, 1 layer", paper, encoder="attention"),
        arm("am", "AM: attention encoder, 3 layers as in the paper", paper, encoder="attention", layers=3),
        arm("capam-none", "no encoder", paper, encoder="none"),
        arm("paper-decoder", "the paper’s decoder: no decision-time features", short),
    )
    return {each.name: each for each in found}


def ablation(only: Sequence[str], seeds: int, budget: TrainingBudget, paper_updates: int, held_out: int) -> Design:
    """The study with these questions, see the flags of `mrta-zoo ablate`.

    Raises:
        ConfigError: if a value is out of range, or there is no such question.
    """
    return Design(
        command="ablate",
        title="Ablation study: what each part of network and training is worth",
        each_run=(
            f"{budget.scenarios} x {budget.samples} episodes per update, {budget.updates} updates with the candidate "
            f"decoder, {paper_updates} with the paper’s (paper-decoder: {budget.updates}, as its reference); "
            f"{ROBOTS[0]} to {ROBOTS[-1]} robots"
        ),
        scatter="pooled over the arms of a question with the same decoder, as in a one-way analysis of variance",
        every_arm=all_arms(budget, paper_updates),
        questions=choose(only, QUESTIONS),
        seeds=seeds,
        budget=budget,
        held_out=HeldOut(budget.tasks, held_out, ROBOTS),
        compared=ROBOTS,
        claims=CLAIMS,
        settings={"paper_updates": paper_updates},
    )
