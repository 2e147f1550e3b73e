"""Comparing methods: every plan is scored by the verifier and by nothing else."""
