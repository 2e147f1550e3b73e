"""Methods that need no training: dispatching rules, matching, local search, exact and open solvers."""
