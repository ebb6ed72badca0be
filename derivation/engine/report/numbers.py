"""Numbers as LaTeX: two decimals or three significant figures, or a power of ten."""


def number(value: float | str) -> str:
    """Two or three significant figures, large ones as powers of ten."""
    if isinstance(value, str):
        return r"$\infty$"
    if 0 < abs(value) < 1e-2 or abs(value) >= 1e4:
        mantissa, _, exponent = f"{value:.1e}".partition("e")
        return rf"${mantissa}\cdot10^{{{int(exponent)}}}$"
    return f"{value:.2f}"


def rounded(value: float) -> str:
    """Three significant figures, small and large numbers as powers of ten."""
    if 1e-2 <= abs(value) < 1e4:
        return f"${value:.3g}$"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    lead = "" if mantissa == "1.0" else rf"{mantissa}\cdot"
    return rf"${lead}10^{{{int(exponent)}}}$"
