"""Policies and solvers: heuristics, and networks that share one set of weights among all robots."""
