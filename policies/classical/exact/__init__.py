"""Provably most tasks: dynamic programming for each robot, then set packing by an integer program."""
