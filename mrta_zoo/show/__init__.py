"""Presentation: missions, plans and episodes as text, pictures and pages. The model knows nothing of it."""
