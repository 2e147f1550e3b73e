"""``mrta-zoo sharing``: should robots share one policy? Trained shared, by kind and each alone, otherwise equal."""
