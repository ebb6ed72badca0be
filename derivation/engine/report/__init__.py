"""The report: LaTeX from formulas and recorded measurements, converted to HTML and PDF."""
