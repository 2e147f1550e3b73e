"""The CapAM network (paper §III) and its relatives: encoders, context, decision-time features, decoder."""
