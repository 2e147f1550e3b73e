"""Checks that errors are one sentence."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.errors import MrtaError


def check_sentence(error: MrtaError, *parts: str) -> None:
    """Check that it has all these parts, on one line, not too long, with no second traceback."""
    message = str(error)
    for part in parts:
        assert part in message, f"{part!r} is not in {message!r}"
    assert "\n" not in message
    assert len(message) < 600
    assert error.__cause__ is None
    assert error.__suppress_context__ or error.__context__ is None  # no second traceback above it


def names(cases: Sequence[tuple[str | bytes, str]]) -> list[str]:
    """Test ids: the message that each case must give."""
    return [message for _, message in cases]
