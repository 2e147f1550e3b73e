"""``mrta-zoo ablate``: what each part of network and training is worth, by training without it."""
