"""Numbers of things in words."""

from __future__ import annotations


def counted(count: int, singular: str, plural: str = "", form: str = "") -> str:
    """1 case, 2 cases.

    Args:
        count: how many, >= 0.
        singular: what they are.
        plural: that of more or less than one, if it is not just an s longer.
        form: of the number, as after the colon in a format string.
    """
    return f"{count:{form}} {singular if count == 1 else plural or singular + 's'}"
