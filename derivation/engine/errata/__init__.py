"""Comparison of published equations with derived ones: misprints and their corrections."""
