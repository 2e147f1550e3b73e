"""Where robots are between their decisions."""

from __future__ import annotations

import pytest
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskRule
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.verify import verify


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_a_robot_works_from_the_moment_at_which_the_verifier_has_it_arrive(rule: MaskRule) -> None:
    ties = 0
    for seed, scenario in enumerate(seeded_scenarios(200, 500)):
        mission, choose = Mission(scenario, rule), seeded_chooser(seed)
        while not mission.done:
            mission.assign(choose(mission.mask(mission.actor)))
            schedule = verify(scenario, Plan.of(mission.routes)).schedule
            for robot, task in enumerate(mission.heading):
                if task < 0:
                    continue
                arrival, here = schedule[robot][-1].arrival, whereabouts(mission, robot)
                ties += mission.time == arrival > 0
                assert here.doing == ("working" if mission.time >= arrival else "travelling")
                if here.doing == "working":
                    assert [here.x, here.y] == scenario.task_xy[task].tolist()
    assert ties > 4
