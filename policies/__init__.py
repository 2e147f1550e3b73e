"""Policies, which decide for one robot at a time, and solvers, which plan whole missions.

`classical`: dispatching rules, BiG-MRTA, iterated local search, exact search, and PyVRP. `neural`: trained networks,
which are both.
"""
