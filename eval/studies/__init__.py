"""Studies that train networks, ``mrta-zoo ablate`` and ``mrta-zoo sharing``: runs, held-out scenarios, differences."""
