"""``mrta-zoo converge``: how good plans are after how much time."""
