"""Writing scenarios as a folder of cases."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from mrta_zoo.errors import ConfigError, ScenarioError
from mrta_zoo.io.formats import FORMATS, FormatName
from mrta_zoo.io.paths import check_no_url
from mrta_zoo.scenario import Scenario


def write_case_folder(scenarios: Iterable[Scenario], folder: Path, file_format: FormatName) -> None:
    """Write scenarios as a folder that `io.read_cases` reads; all of them or none.

    TAPTC task files go to ``group1/NAME.txt`` and their agent files to ``agent/NAME.txt``, JSON and CSV files into the
    folder itself.

    Args:
        scenarios: what to write; their names must differ and be valid file names.
        folder: must not exist yet, or be empty; it may be the current one, or a link to one.
        file_format: format of the files.

    Raises:
        ConfigError: if the folder is not empty or cannot be made, or there is no such format.
        ScenarioError: if the format cannot express a scenario.
    """
    suffixes = {form.name: suffix for suffix, form in FORMATS.items()}
    if file_format not in suffixes:
        raise ConfigError(f"format is {file_format!r}; expected one of {', '.join(suffixes)}")
    check_no_url(folder, ConfigError)
    try:
        if folder.is_dir() and any(folder.iterdir()):
            raise ConfigError(f"{folder} is not empty; expected a new or empty folder")
        if folder.exists() and not folder.is_dir():
            raise ConfigError(f"{folder} is a file; expected a new or empty folder")
        final = Path(os.path.realpath(folder))
        new = not final.is_dir()
        partial = final / f".unfinished.{secrets.token_hex(8)}"
        partial.mkdir(parents=True)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be made: {(error.strerror or str(error)).lower()}") from None
    try:
        for scenario in scenarios:
            _write_case(scenario, partial, suffixes[file_format])
        for path in sorted(partial.iterdir()):
            path.replace(final / path.name)
        new = False
    except ScenarioError as error:  # it names the file where it is now
        raise ScenarioError(str(error).replace(str(partial), str(folder))) from None
    except OSError as error:
        raise ConfigError(f"{folder} cannot be written: {(error.strerror or str(error)).lower()}") from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        if new:
            with suppress(OSError):
                final.rmdir()


def _write_case(scenario: Scenario, folder: Path, suffix: str) -> None:
    place = folder / "group1" if FORMATS[suffix].grouped else folder
    place.mkdir(exist_ok=True)
    FORMATS[suffix].write(scenario, place / f"{scenario.name}{suffix}", folder / "agent")
