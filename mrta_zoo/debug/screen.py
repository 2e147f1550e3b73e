"""A session as text on a terminal of any size, or on none."""

from __future__ import annotations

import numpy as np
from rich import box
from rich.cells import cell_len
from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from mrta_zoo.debug.called import called, shortened
from mrta_zoo.debug.pages import Listing
from mrta_zoo.debug.session import Session
from mrta_zoo.fold import clipped
from mrta_zoo.rules import Status
from mrta_zoo.scenario import Scenario

AROUND = 11
"""Lines of a screen besides the rows of the table: the header, the table's title, head and foot, message and prompt."""
LEAST_ROWS = 3
BETWEEN = 2
"""Columns between two of a table."""
STYLES = {"advised": "bold green", "made": "yellow", "plain": "", "faint": "bright_black"}
NEXT_SHOWN = 8
NOTE, NAME, LEAST_NOTE = 24, 10, 12
"""Columns that notes keep until names are cut, that names keep until notes are cut further, and that notes keep."""


def screen(session: Session, rows: int, width: int, message: str = "") -> Group:
    """Everything there is to be seen, in so many columns and with so many rows of the table that is looked at."""
    parts: list[RenderableType] = [*header(session, width), Text()]
    parts += table(session, rows, width)
    parts.append(Text(clipped(message, width), style="bold"))
    return Group(*parts)


def fit(console: Console) -> int:
    """How many rows of a table a screen has room for."""
    return max(console.height - AROUND, LEAST_ROWS)


def header(session: Session, width: int) -> list[RenderableType]:
    """Four lines: the mission, how it stands, who is to choose and what its policy thinks, and who is next."""
    stepper = session.stepper
    mission, scenario = stepper.mission, stepper.scenario
    count = np.bincount(mission.status, minlength=len(Status))
    place = f"decision {stepper.position}" + (f"/{len(stepper)}" if stepper.position < len(stepper) else "")
    lines = [
        (
            f"{scenario.name}: {scenario.size}, {stepper.mask_rule}",
            "bold",
        ),
        (
            f"time {mission.time:.1f}  {place}  {count[Status.COMPLETED]} completed, {count[Status.ASSIGNED]} under "
            f"way, {count[Status.MISSED]} missed, {count[Status.ACTIVE]} open",
            "",
        ),
    ]
    if stepper.done:
        lines += [(session.where(), "bold"), ("", "")]
    else:
        lines += [(_turn(session), "bold cyan"), (_queue(session), "bright_black")]
    return [Text(clipped(line, width), style=style) for line, style in lines]


def table(session: Session, rows: int, width: int) -> list[RenderableType]:
    """The table that is looked at: its title, a page of it, and which page that is."""
    listing, view = session.listing(), session.view
    pages = max(-(-len(listing.rows) // rows), 1)
    view.page = min(view.page, pages - 1)
    shown = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1, 0, 0))
    first = view.page * rows
    page = listing.rows[first : first + rows]
    widths = column_widths(listing, width)
    for index, needed in widths.items():
        column = listing.columns[index]
        shown.add_column(column, justify="left" if column in listing.left else "right", no_wrap=True, width=needed)
    for row in page:
        *cells, note = (row.cells[index] for index in widths)
        shown.add_row(*map(Text, cells), Text(clipped(note, [*widths.values()][-1])), style=STYLES[row.tone])
    foot = f"page {view.page + 1} of {pages}" + ("" if view.page == pages - 1 else ", n: next") if pages > 1 else ""
    title, foot = (clipped(text, width) for text in (listing.title, foot))
    return [Text(title, style="italic"), shown, Text(foot, style="bright_black")]


def column_widths(listing: Listing, width: int) -> dict[int, int]:
    """The columns that there is room for, with their widths.

    Numbers have what they need. Where there is no room, first the notes in the last column are cut, then names; then
    columns are left out, those that can be spared first.
    """
    widths = {
        index: max(cell_len(cell) for cell in (column, *(row.cells[index] for row in listing.rows)))
        for index, column in enumerate(listing.columns)
    }
    last = len(widths) - 1
    names = [index for index, column in enumerate(listing.columns) if column in listing.left and 0 < index < last]

    def over() -> int:
        return max(0, sum(widths.values()) + BETWEEN * (len(widths) - 1) - width)

    for index, least in ((last, NOTE), *((name, NAME) for name in names), (last, LEAST_NOTE)):
        widths[index] -= min(over(), max(widths[index] - least, 0))
    for column in (*listing.spare, listing.columns[last]):
        if over():
            del widths[last if column == listing.columns[last] else listing.columns.index(column)]
    return widths


def prompt(session: Session) -> str:
    """What to ask for a command with."""
    advice = session.stepper.advice
    if advice is None:
        return "? help, q quit > "
    scenario = session.stepper.scenario
    chosen = _choice(scenario, advice.task, 12)
    other = "name" if scenario.task_names else "number"
    return f"Enter: {chosen}, or {other}; b back, f forward, ? help, q quit > "


def _turn(session: Session) -> str:
    stepper = session.stepper
    robot, scenario = stepper.robot, stepper.scenario
    x, y = stepper.mission.position[robot]
    what = ""
    if (advice := stepper.advice) is not None:
        what = f"; {stepper.method or 'policy'}: {_choice(scenario, advice.task, 16)}"
    return (
        f"{shortened(scenario.robot_name(robot), 16)} chooses{what}; at ({x:.1f}, {y:.1f}), "
        f"capacity {scenario.capacity[robot]:.3g}, speed {scenario.speed[robot]:.3g}"
    )


def _choice(scenario: Scenario, task: int | None, most: int) -> str:
    """A choice, the task's name in so many columns."""
    return "stay" if task is None else f"task {shortened(scenario.task_name(task), most)}"


def _queue(session: Session) -> str:
    """Who chooses after the acting robot."""
    mission = session.stepper.mission
    waiting = sorted(
        (ready, robot)
        for robot, ready in enumerate(mission.ready)
        if not mission.retired[robot] and robot != mission.actor
    )
    if not waiting:
        return "the only robot left"
    names = mission.scenario.robot_names
    text = ", ".join(f"{shortened(called(robot, names), 16)} at {ready:.1f}" for ready, robot in waiting[:NEXT_SHOWN])
    return f"next robots: {text}" + (", …" if len(waiting) > NEXT_SHOWN else "")
