"""``mrta-zoo reproduce``: the paper's experiments, in one command, as a report."""
