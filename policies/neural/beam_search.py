"""Beam search: many unfinished missions side by side, of which the likeliest go on."""

from __future__ import annotations

from collections.abc import Iterator

import torch

from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.inputs import Tasks, Watch
from mrta_zoo.policies.neural.rollout import NOT_FINITE, Scorer
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch


@torch.no_grad()
def beam_search(
    network: Scorer,
    scenario: ScenarioBatch,
    width: int,
    *,
    mask_rule: MaskRule = "feasible",
    limit: TimeLimit | None = None,
) -> Iterator[BatchMission]:
    """Missions as they are finished, in batches.

    All unfinished missions take one decision per step. Of all continuations the `width` likeliest are kept, by the
    probability of all their decisions together; the first among equals. A finished mission is yielded and makes room:
    left in the beam it would crowd out longer ones, since each decision makes a mission less likely.

    No two missions of a beam are ever the same: what was decided follows from the routes, as robots act in the order
    of time.

    Args:
        network: scores the tasks.
        scenario: one scenario.
        width: how many missions are unfinished at a time, >= 1; with 1 the only mission is the greedy one.
        mask_rule: what robots may choose.
        limit: when to stop, even with unfinished missions; None never stops.

    Raises:
        ConfigError: if the network gives probabilities that are not finite.
    """
    encoding = network.encode(Tasks.of_batch(scenario))
    mission = BatchMission(scenario, mask_rule)
    log_prob = torch.zeros(1, dtype=torch.float64, device=scenario.device)
    while True:
        if mission.done.any():
            yield mission.select(mission.done.nonzero().squeeze(1))
            unfinished = (~mission.done).nonzero().squeeze(1)
            mission, log_prob = mission.select(unfinished), log_prob[unfinished]
        if len(log_prob) == 0 or (limit is not None and limit.over):
            return
        states = Watch(mission, len(log_prob)).states()
        step = network(encoding, states, network.features(encoding, states))[0]
        if torch.isnan(step).any():
            raise ConfigError(NOT_FINITE)
        step = step.masked_fill(~states.mask[0], -torch.inf)
        total, order = (log_prob[:, None] + step).flatten().sort(descending=True, stable=True)
        chosen = order[: min(width, int(torch.isfinite(total).sum()))]
        if len(chosen) == 0:
            raise ConfigError(NOT_FINITE)
        log_prob = total[: len(chosen)]
        mission = mission.select(chosen // step.shape[1])
        mission.step(chosen % step.shape[1])
