"""Scenarios, plans, traces and benchmark cases as files."""

from mrta_zoo.io.cases import Case, read_cases
from mrta_zoo.io.files import read_scenario, write_scenario
from mrta_zoo.io.plan_format import read_plan, write_plan
from mrta_zoo.io.taptc import write_taptc
from mrta_zoo.io.trace_format import read_trace, write_trace

__all__ = [
    "Case",
    "read_cases",
    "read_plan",
    "read_scenario",
    "read_trace",
    "write_plan",
    "write_scenario",
    "write_taptc",
    "write_trace",
]
