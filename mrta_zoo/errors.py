"""Errors meant to be read by people: one sentence that says what was wrong, where, and what would be right."""


class MrtaError(ValueError):
    """Base of every error this package raises about its input. The command line prints it without a traceback."""

    def __str__(self) -> str:
        # A file name that is not UTF-8 could not be printed.
        return super().__str__().encode(errors="backslashreplace").decode()


class ScenarioError(MrtaError):
    """A scenario, or a file that should hold one, breaks a rule of the problem."""


class PlanError(MrtaError):
    """A plan does not fit its scenario: wrong robots, unknown tasks, or a task taken twice."""


class ActionError(MrtaError):
    """An agent chose something it may not choose now."""


class OutOfBoundsError(ActionError, AssertionError):
    """An action outside the action space; also what PettingZoo's wrapper raises for it."""


class ConfigError(MrtaError):
    """A configuration, checkpoint or option has a value that cannot be used."""


class MissingExtraError(MrtaError, ImportError):
    """An optional dependency is needed but missing; the message names the extra that installs it."""
