"""Numbers as LaTeX: with two decimals, with three significant digits, or as powers of ten."""


def number(value: float | str) -> str:
    """Return a number with two decimals, or as a power of ten; text stands for infinity."""
    if isinstance(value, str):
        return r"$\infty$"
    if 0 < abs(value) < 1e-2 or abs(value) >= 1e4:
        mantissa, _, exponent = f"{value:.1e}".partition("e")
        return rf"${mantissa}\cdot10^{{{int(exponent)}}}$"
    return f"{value:.2f}"


def rounded(value: float) -> str:
    """Return a number with three significant digits; small and large ones as powers of ten."""
    if 1e-2 <= abs(value) < 1e4:
        text = f"{value:.3g}"
        return f"${float(text):.0f}$" if "e" in text else f"${text}$"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    lead = "" if mantissa == "1.0" else rf"{mantissa}\cdot"
    return rf"${lead}10^{{{int(exponent)}}}$"
