"""Text at a terminal of any width."""
