"""Local search on plans in which every visited task is completed in time: ILS, and an EILS-style search.

Compiled with Numba. Whether an insertion is feasible takes one comparison: each position of a tour stores by how much
all that follows may be delayed (Shift and MaxShift, Vansteenwegen, Souffriau, Vanden Berghe, Van Oudheusden 2009).
"""
