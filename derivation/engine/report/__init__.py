"""Ink: LaTeX rendered from theory and committed measurements, and the PDF made of it."""
