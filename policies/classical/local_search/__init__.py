"""Local search on plans in which every visited task is completed in time: ILS, and an EILS-style search.

Compiled with Numba. Feasibility of an insertion is looked up, not recomputed: each position of a tour knows by how much
all that follows may be delayed (Shift and MaxShift, Vansteenwegen, Souffriau, Vanden Berghe, Van Oudheusden 2009).
"""
