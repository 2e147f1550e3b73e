"""On what timings were taken: enough to judge them by, nothing that says whose machine it is."""

from __future__ import annotations

import os
import platform
import time
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from mrta_zoo.wording import counted

BUSY = 0.6
"""Load a core above which times are not to be trusted."""
LIBRARIES = ("numpy", "torch", "scipy", "numba", "pyvrp", "pandas", "statsmodels", "matplotlib")


@dataclass(frozen=True, slots=True)
class Machine:
    """The machine, as it was during one uninterrupted stretch of measuring.

    Attributes:
        started: when it began, UTC.
        processor: its model.
        cores: CPU cores that this process may use.
        load: processes running or waiting on the whole machine, mean of the minute before; None if unknown.
        threads: CPU threads that trained networks used.
        system: the operating system.
        libraries: versions of Python and of what plans and computes.
    """

    started: str
    processor: str
    cores: int
    threads: int
    system: str
    libraries: str
    load: float | None = None

    @property
    def busy(self) -> bool:
        """Whether others were at work too, so that times are longer than they would be."""
        return self.load is not None and self.load > BUSY * self.cores

    @property
    def description(self) -> str:
        """In a line."""
        load = "unknown" if self.load is None else f"{self.load:g}"
        return (
            f"{self.processor}, {counted(self.cores, 'core')} usable, load {load} at the beginning, "
            f"{counted(self.threads, 'torch thread')} per process, {self.system}; {self.libraries}"
        )


def this_machine(threads: int) -> Machine:
    """This machine, now."""
    found = [f"Python {platform.python_version()}"]
    for library in LIBRARIES:
        try:
            found.append(f"{library} {version(library)}")
        except PackageNotFoundError:
            continue
    return Machine(
        started=time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
        processor=_processor(),
        cores=len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        threads=threads,
        system=platform.system(),
        libraries=", ".join(found),
        load=round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
    )


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as lines:
            for line in lines:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine() or "unknown"
