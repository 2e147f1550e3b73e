"""The demo: a mission step by step, a comparison, a training run, a picture."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from mrta_zoo import mrta_v0
from mrta_zoo.digits import full, rounded, share
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.progress import evaluate_with_progress
from mrta_zoo.eval.runner import solve_and_score
from mrta_zoo.eval.solved_files import write_solved
from mrta_zoo.eval.table import summary_tables
from mrta_zoo.extras import require
from mrta_zoo.io import Case
from mrta_zoo.io.paths import make_folder
from mrta_zoo.io.records import write_records
from mrta_zoo.mission import Mission
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.neural.learned_solver import load_learned
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.plan.picture import save_plan_picture
from mrta_zoo.show.plan.text import totals
from mrta_zoo.show.terminal.console import results_console, say
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.show.view import Digits
from mrta_zoo.suite import builtin_suite
from mrta_zoo.wording import counted

STEPS_SHOWN = 10
COMPARED = ("random", "nearest", "edf", "capam", "capam-plus")
STEPPED, DRAWN = "r13a3i00", "r13a7i00"
"""Cases of the built-in suite: one to step through, one to draw."""
WHY = "why it is its turn"
BARS = "▁▂▃▄▅▆▇█"


def run_demo(folder: Path, policy_name: str = "capam-plus") -> None:
    """Run the demo, leaving ``rows.csv``, ``plan.json``, ``plan.png`` and a training run in `folder`.

    Args:
        folder: is made if it does not exist.
        policy_name: the trained policy to show, by name or path.

    Raises:
        MrtaError: if the folder cannot be made, there is no such policy, or something is not installed.
    """
    begun = time.perf_counter()
    require("torch", "the demo", ("scipy", "filelock"))
    policy = load_learned(policy_name)
    _make(folder)
    console = results_console()
    cases = [Case(scenario.name, scenario) for scenario in builtin_suite()]
    scenarios = {case.name: case.scenario for case in cases}

    _heading(console, "1. Robots take turns in the environment, all under one shared policy")
    with cpu_threads(1):
        show_steps(console, policy, scenarios[STEPPED], STEPS_SHOWN)

    _heading(console, f"2. Methods compared on the built-in suite, {len(cases)} cases, scored by the verifier")
    with cpu_threads(1):
        names = dict.fromkeys((*COMPARED, policy_name))
        rows = evaluate_with_progress(cases, {name: make_solver(name) for name in names})
    for table in summary_tables(rows):
        console.print(table, crop=False)
    write_records(rows, folder / "rows.csv")
    say(console, f"all rows: {folder / 'rows.csv'}")

    _heading(console, "3. A small policy learns from scratch by REINFORCE")
    with cpu_threads(1):  # a second one gains 18 %, at the price of other results
        show_training(console, _new_folder(folder / "training"))

    _heading(console, "4. A plan as a picture")
    with cpu_threads(1):
        solved = solve_and_score(make_solver(policy_name), scenarios[DRAWN])
    say(console, f"{DRAWN} planned by {policy_name} in {rounded(solved.seconds, 3)} s:")
    say(console, totals(solved.score))
    write_solved(solved, folder / "plan.json")
    save_plan_picture(scenarios[DRAWN], solved.plan, folder / "plan.png", solved.score)
    say(console, f"routes and schedule: {(folder / 'plan.png').resolve()} (the data: plan.json)")
    say(console, f"\nThe demo took {time.perf_counter() - begun:.0f} s.")


def show_steps(console: Console, policy: Policy, scenario: Scenario, steps: int) -> None:
    """Print the first turns of a mission: the time, the robot, why it is its turn, and its choice.

    Args:
        console: where to print.
        policy: decides for every robot.
        scenario: the mission.
        steps: number of turns to print.
    """
    env = mrta_v0.raw_env(scenario=scenario)
    env.reset()
    say(console, f"{scenario.name}: {scenario.size}")
    rows: list[tuple[str, ...]] = []
    turns, digits = 0, Digits.of(scenario)
    for agent in env.agent_iter():
        observation, _, termination, truncation, info = env.last()
        if termination or truncation:
            env.step(None)
            continue
        task = policy.act(observation, agent)
        reason = why_now(env.mission)
        env.step(task)
        if turns < steps:
            choices = str(int(observation["action_mask"].sum()))
            done, due = digits.time(env.mission.finish[task]), full(scenario.deadline[task])
            rows.append((digits.time(info["time"]), agent, reason, f"task {task}", choices, done, due))
        turns += 1
    headings = ("time", "robot", WHY, "chose", "out of", "done at", "deadline")
    console.print(Sheet("", headings, rows, left=("robot", WHY), prose=WHY), crop=False)
    say(
        console,
        f"… and so on: after {counted(turns, 'turn')} no robot has a task left that it can finish in time; "
        f"{env.mission.completed()} of {counted(scenario.num_tasks, 'task')} are completed.",
    )


def why_now(mission: Mission) -> str:
    """Why the acting robot acts before the others."""
    also_free = [robot for robot in mission.free() if robot != mission.actor]
    if also_free:
        return f"free, as {_listed(also_free)} {'is' if len(also_free) == 1 else 'are'}; lowest number first"
    busy = [robot for robot in range(mission.scenario.num_robots) if mission.heading[robot] >= 0]
    if busy:
        digits = Digits.of(mission.scenario)
        until = ", ".join(f"robot_{robot} until {digits.time(mission.ready[robot])}" for robot in busy)
        return f"free first; busy: {until}"
    return "the only one with anything left to choose"


def show_training(console: Console, folder: Path) -> None:
    """Train a small policy in a new folder for a minute or so, and print how its validation completion rises."""
    from mrta_zoo.train import checkpoint
    from mrta_zoo.train.presets import PRESETS
    from mrta_zoo.train.run import train

    run = checkpoint.start(folder, PRESETS["smoke"])
    train(run, folder, console=console)
    completion = [each.completion for each in run.history]
    say(
        console,
        f"validation completion {share(completion[0])} % -> {share(completion[-1])} %  {spark_line(completion)}",
    )


def spark_line(values: Sequence[float]) -> str:
    """Values as a row of bars; the least value is the lowest bar."""
    low, high = min(values), max(values)
    scale = (len(BARS) - 1) / (high - low) if high > low else 0.0
    return "".join(BARS[round((value - low) * scale)] for value in values)


def _heading(console: Console, text: str) -> None:
    say(console, f"\n{text}\n{'=' * len(text)}")


def _listed(robots: Sequence[int]) -> str:
    names = [f"robot_{robot}" for robot in robots]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _make(folder: Path) -> None:
    try:
        make_folder(folder)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be made: {(error.strerror or str(error)).lower()}") from None


def _new_folder(path: Path) -> Path:
    """`path`, with a number appended if an earlier demo left something there."""
    candidate, number = path, 1
    while candidate.exists():
        number += 1
        candidate = path.with_name(f"{path.name}-{number}")
    return candidate
