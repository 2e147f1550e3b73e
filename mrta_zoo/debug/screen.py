"""The screen of a session: text for a terminal of any size, or for none."""

from __future__ import annotations

import numpy as np
from rich import box
from rich.cells import cell_len
from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from mrta_zoo.debug.naming import shortened
from mrta_zoo.debug.pages import Listing
from mrta_zoo.debug.session import Session
from mrta_zoo.digits import rough
from mrta_zoo.rules import Status
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.fold import clipped
from mrta_zoo.show.view import Digits

AROUND = 11
"""Lines of a screen besides the table's rows: header, title, head and foot of the table, message and prompt."""
LEAST_ROWS = 3
BETWEEN, TIGHT = 2, 1
"""Blanks between two columns of a table, and the same where there is no room."""
STYLES = {"advised": "bold green", "made": "yellow", "plain": "", "faint": "bright_black"}
NEXT_SHOWN = 8
NAME, LEAST_NAME, LEAST_NOTE = 10, 6, 12
"""Widths: names are cut down to `NAME` before names in notes are, and never below `LEAST_NAME`; notes keep
`LEAST_NOTE`."""


def screen(session: Session, rows: int, width: int, message: str = "") -> Group:
    """The whole screen: header, table and message.

    Args:
        session: what to show.
        rows: of the table, on one page.
        width: of the screen, in columns.
        message: the last line.
    """
    parts: list[RenderableType] = [*header(session, width), Text()]
    parts += table(session, rows, width)
    parts.append(Text(clipped(message, width), style="bold"))
    return Group(*parts)


def fit(console: Console) -> int:
    """The number of rows of a table that a screen has room for."""
    return max(console.height - AROUND, LEAST_ROWS)


def header(session: Session, width: int) -> list[RenderableType]:
    """Four lines: the mission, its state, who chooses and what the policy advises, and who is next."""
    stepper = session.stepper
    mission, scenario = stepper.mission, stepper.scenario
    count = np.bincount(mission.status, minlength=len(Status))
    place = f"decision {stepper.position}" + (f"/{len(stepper)}" if stepper.position < len(stepper) else "")
    lines = [
        (
            f"{scenario.name}: {scenario.size}, mask rule {stepper.mask_rule}",
            "bold",
        ),
        (
            f"time {Digits.of(scenario).time(mission.time)}  {place}  {count[Status.COMPLETED]} completed, "
            f"{count[Status.ASSIGNED]} under way, {count[Status.MISSED]} missed, {count[Status.ACTIVE]} open",
            "",
        ),
    ]
    if stepper.done:
        lines += [(session.where(), "bold"), ("", "")]
    else:
        lines += [(_turn(session, width), "bold cyan"), (_queue(session, width), "bright_black")]
    return [Text(clipped(line, width), style=style) for line, style in lines]


def table(session: Session, rows: int, width: int) -> list[RenderableType]:
    """The table that the user looks at: its title, a page of its rows, and which page that is."""
    listing, view = session.listing(), session.view
    pages = max(-(-len(listing.rows) // rows), 1)
    view.page = min(view.page, pages - 1)
    first = view.page * rows
    page = listing.rows[first : first + rows]
    widths, between = column_widths(listing, width)
    shown = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, between - TIGHT, 0, 0))
    for index, needed in widths.items():
        column = listing.columns[index]
        shown.add_column(column, justify="left" if column in listing.left else "right", no_wrap=True, width=needed)
    alike = [tuple(sorted(set(cells))) for cells in zip(*(row.cells for row in listing.rows), strict=True)]
    named = tuple(sorted({row.name for row in listing.rows}))
    for row in page:
        cells = [
            clipped(row.note(needed, LEAST_NAME, named), needed) if index == len(row.cells) - 1
            else shortened(row.cells[index], needed, alike[index])
            for index, needed in widths.items()
        ]  # fmt: skip
        shown.add_row(*map(Text, cells), style=STYLES[row.tone])
    foot = f"page {view.page + 1} of {pages}" + ("" if view.page == pages - 1 else ", n: next") if pages > 1 else ""
    title, foot = (clipped(text, width) for text in (listing.title, foot))
    return [Text(title, style="italic"), shown, Text(foot, style="bright_black")]


def column_widths(listing: Listing, width: int) -> tuple[dict[int, int], int]:
    """The widths of the columns that there is room for, and the blanks between two columns.

    Numbers are never cut. Where room is short, names are shortened first, including those in notes; then columns are
    left out, the most dispensable first; then the notes in the last column are cut. What the row is about always stays.
    """
    needed = {
        index: max(cell_len(cell) for cell in (column, *(row.cells[index] for row in listing.rows)))
        for index, column in enumerate(listing.columns)
    }
    last = len(needed) - 1
    names = [index for index, column in enumerate(listing.columns) if column in listing.left and 0 < index < last]
    readable = max((cell_len(row.note(0, LEAST_NAME)) for row in listing.rows), default=0)

    def over() -> int:
        return max(0, sum(widths.values()) + between * (len(widths) - 1) - width)

    def narrow(index: int, least: int) -> None:
        widths[index] -= min(over(), max(widths[index] - least, 0))

    for between in (BETWEEN, TIGHT):
        widths = dict(needed)
        for name in names:
            narrow(name, NAME)
        if not over():
            return widths, between
    for index, least in ((last, readable), *((name, LEAST_NAME) for name in names)):
        narrow(index, least)
    for column in listing.spare:
        if over():
            del widths[listing.columns.index(column)]
    narrow(last, LEAST_NOTE)
    for index in [index for index in reversed(widths) if index > min(1, last - 1)]:
        if over():
            del widths[index]
    return widths, between


def prompt(session: Session) -> str:
    """The prompt for a command."""
    advice = session.stepper.advice
    if advice is None:
        return "? help, q quit > "
    scenario = session.stepper.scenario
    chosen = "stay" if advice.task is None else _task(scenario, advice.task, 12)
    other = "name" if scenario.task_names else "number"
    return f"Enter: {chosen}, or {other}; b back, f forward, ? help, q quit > "


def _turn(session: Session, width: int) -> str:
    """Who chooses, and what the policy advises. What has no room is left out, first the speed."""
    stepper = session.stepper
    robot, scenario, advice = stepper.robot, stepper.scenario, stepper.advice
    x, y = map(Digits.of(scenario).distance, stepper.mission.position[robot])
    who = shortened(scenario.robot_name(robot), 16, scenario.robot_names)
    about = [
        f" at ({x}, {y})",
        f"capacity {rough(scenario.capacity[robot])}",
        f"speed {rough(scenario.speed[robot])}",
    ]
    what = "chooses"
    if advice is not None:
        chosen = "to stay" if advice.task is None else _task(scenario, advice.task, 16)
        what += f"; {shortened(stepper.method or 'the policy', 24)} advises {chosen}"
    lines = [f"{who}{', '.join(about[:told])}, {what}" for told in (3, 2, 1)]
    return next((line for line in lines if cell_len(line) <= width), f"{who} {what}")


def _task(scenario: Scenario, task: int, most: int) -> str:
    """A task's name cut to `most` columns, or its number."""
    return shortened(scenario.task_name(task), most, scenario.task_names) if scenario.task_names else f"task {task}"


def _queue(session: Session, width: int) -> str:
    """The robots that choose after the acting one, as many as there is room for."""
    mission, scenario = session.stepper.mission, session.stepper.scenario
    digits = Digits.of(scenario)
    waiting = sorted(
        (ready, robot)
        for robot, ready in enumerate(mission.ready)
        if not mission.retired[robot] and robot != mission.actor
    )
    if not waiting:
        return "the only robot left"
    each = [
        f"{shortened(scenario.robot_name(robot), 16, scenario.robot_names)} at {digits.time(ready)}"
        for ready, robot in waiting
    ]
    lines = [f"next: {', '.join(each)}", *(f"next: {', '.join(each[:some])}, …" for some in range(NEXT_SHOWN, 0, -1))]
    return next((line for line in lines if cell_len(line) <= width), lines[-1])
