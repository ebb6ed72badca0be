"""Parse LaTeX of the paper and of this program's printer, with the checks of `parse`.

The LaTeX is translated into the syntax of `parse`, which checks the result.
"""

import re
from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

from derivation.engine.formula.elementary import ELEMENTARY, OTHER_NAMES
from derivation.engine.formula.latex_tokens import tokens_of, unknown, with_plain_names
from derivation.engine.formula.parse import (
    MAX_NESTING,
    MAX_TEXT,
    FormulaError,
    parse,
)
from derivation.engine.formula.vocabulary import Vocabulary

_FUNCTIONS = {*ELEMENTARY, *OTHER_NAMES}
_INVERTIBLE = re.compile(r"sinh?|cosh?|tanh?|coth?")
_GREEK = {r"\lambda": "lam", r"\mu": "mu", r"\phi": "phi", r"\varphi": "phi", r"\pi": "pi"} | {
    rf"\{name}": name
    for name in (
        *("Omega", "delta", "xi", "gamma", "eta", "alpha", "kappa", "nu", "omega", "rho"),
        *("beta", "chi", "epsilon", "psi", "sigma", "tau", "theta", "zeta"),
        *("varepsilon", "varkappa", "vartheta"),
    )
}
_BRACKETS = {"(": ")", "[": "]", r"\{": r"\}", "{": "}", r"\lvert": r"\rvert"}
_NAME = r"(?:\\[A-Za-z]+|[A-Za-z])(?: _ (?:\w+|\{ \w+ \}))?"
_ARGUMENTS = re.compile(rf"[(\[] ({_NAME}(?: , {_NAME})*) [)\]]")
"""Only symbols in brackets, as tokens separated by spaces."""
_PLAIN = r"write \int_{a}^{b} f \, dx; without LaTeX, write Integral(f, (x, a, b))"
_PRODUCT = {r"\cdot", r"\times", "*"}


def parse_latex(
    text: str,
    vocabulary: Vocabulary,
    also: Mapping[str, sp.Basic] | None = None,
    preferred: Mapping[str, str] | None = None,
    applied: Mapping[str, tuple[str, ...]] | None = MappingProxyType({}),
) -> sp.Expr:
    r"""Return the expression for a LaTeX formula.

    Parameters
    ----------
    text
        The formula, such as ``\frac{1}{\phi_j} \sinh(\phi_j z)``. A product needs no sign.
    vocabulary, also
        As in `derivation.engine.formula.parse.parse`.
    preferred
        Names by LaTeX without backslashes and braces, for letters with several meanings.
    applied
        Arguments that may follow a name in brackets, in addition to those of `vocabulary`. None if
        they are not known: then any name may have arguments, and the result is meaningless.

    Raises
    ------
    FormulaError
        If a token is not recognised, or if `parse` raises it.
    """
    if not isinstance(text, str):
        raise FormulaError(f"expected a formula as text, got {type(text).__name__}")
    if len(text) > MAX_TEXT:
        raise FormulaError(f"expected at most {MAX_TEXT} characters, got {len(text)}: split it")
    allowed = {**(also or {}), **vocabulary.names}
    text, own = with_plain_names(text, vocabulary.arguments)
    known = None if applied is None else {**applied, **vocabulary.applied}
    translator = _Translator(
        tokens_of(text), vocabulary, allowed, {**own, **(preferred or {})}, known
    )
    plain = translator.sum()
    if translator.here is not None:
        raise FormulaError(
            f"expected an operator or the end, got {translator.here!r}: leave it out"
        )
    return parse(plain, vocabulary, also)


class _Translator:
    """Recursive-descent parser of the tokens; each method returns the text for its part."""

    def __init__(
        self,
        tokens: list[str],
        vocabulary: Vocabulary,
        allowed: Mapping[str, sp.Basic],
        preferred: Mapping[str, str],
        applied: Mapping[str, tuple[str, ...]] | None,
    ) -> None:
        self.tokens = tokens
        self.applied = applied
        self.preferred = preferred
        self.vocabulary = vocabulary
        self.allowed = allowed
        self.position = 0
        self.depth = 0
        self.bars = 0
        self.integrals = [0]  # open ones, by level of brackets

    @property
    def here(self) -> str | None:
        return self.tokens[self.position] if self.position < len(self.tokens) else None

    def take(self, expected: str | None = None) -> str:
        token = self.here
        if token is None:
            raise FormulaError(f"expected {expected or 'more'!r}, the LaTeX ends: complete it")
        if expected is not None and token != expected:
            raise FormulaError(f"expected {expected!r} in the LaTeX, got {token!r}: correct it")
        self.position += 1
        return token

    def sum(self) -> str:
        parts = [self._signs() + self.product()]
        while self.here in ("+", "-"):
            parts.append(self.take() + self._signs() + self.product())
        return "".join(parts)

    def _signs(self) -> str:
        """Return the signs before a term; a sum on two lines repeats the operator."""
        signs = ""
        while self.here in ("+", "-"):
            signs += self.take()
        if len(signs) > 2:
            raise FormulaError(f"expected at most two signs in a row, got {signs:.20}: merge them")
        return signs

    def product(self) -> str:
        parts = [self.factor()]
        while not self._at_end():
            operator = "*"
            if self.here in _PRODUCT or self.here == "/":
                operator = "/" if self.take() == "/" else "*"
            parts.append(operator + self.factor())
        return "".join(parts)

    def _at_end(self) -> bool:
        """Return whether a product ends here."""
        return (
            self.here in (None, "+", "-", ",", *_BRACKETS.values())
            or (self.here == "|" and self.bars > 0)
            or (self.here == "d" and self.integrals[-1] > 0)
        )

    def factor(self) -> str:
        base = self.primary()
        if base.isidentifier() and self.applied is not None:
            self._refuse_unknown_function(base)
        while self.here == "!":
            self.take()
            base = f"factorial({base})"
        if self.here != "^":
            return base
        raised = f"({base})**({self.exponent()})"
        if self.here == "^":
            raise FormulaError("expected one power, got a second '^': set braces around the first")
        return raised

    def exponent(self) -> str:
        self.take("^")
        if self.here == "{":
            return self.bracket()
        return self.single()

    def single(self) -> str:
        """Return the single token that a power or a fraction takes without braces."""
        token = self.here
        if token is not None and token.isdigit() and len(token) > 1:
            self.tokens[self.position] = token[1:]
            return token[0]
        return self.primary()

    def bracket(self) -> str:
        """Return the text between a pair of brackets."""
        opening = self.take()
        if opening not in _BRACKETS:
            raise FormulaError(
                f"expected brackets or braces in the LaTeX, got {opening!r}: add them"
            )
        self.integrals.append(0)
        inside = self.sum()
        self.integrals.pop()
        self.take(_BRACKETS[opening])
        return inside

    def primary(self) -> str:
        self.depth += 1
        if self.depth > MAX_NESTING:
            raise FormulaError(f"the LaTeX is nested deeper than {MAX_NESTING} levels: split it")
        text = self._primary()
        self.depth -= 1
        return text

    def _primary(self) -> str:
        token = self.here
        if token == r"\lvert":
            return f"abs({self.bracket()})"
        if token in _BRACKETS:
            return f"({self.bracket()})"
        token = self.take()
        if token == "|":
            return self._between_bars()
        if token[0].isdigit():
            return token
        if token in (r"\frac", r"\dfrac", r"\tfrac", r"\cfrac"):
            above, below = (self.bracket() if self.here == "{" else self.single() for _ in range(2))
            return f"(({above})/({below}))"
        if token == r"\sqrt":
            return self._root()
        if token == r"\int":
            return self._integral()
        if token.startswith("\\") and token[1:] in _FUNCTIONS:
            return self._function(token[1:])
        if token == r"\Gamma":
            return self._function("gamma")
        if token == "e":
            return f"exp({self.exponent()})" if self.here == "^" else "exp(1)"
        if token in _GREEK or token.isalpha():
            return self._symbol(_GREEK.get(token, token))
        raise unknown(token)

    def _between_bars(self) -> str:
        self.bars += 1
        inside = self.sum()
        self.take("|")
        self.bars -= 1
        return f"abs({inside})"

    def _integral(self) -> str:
        """Return an integral, which begins with its limits and ends with the differential."""
        if "d" in self.allowed:
            raise FormulaError(
                rf"the symbol d and the differential of \int cannot be told apart: {_PLAIN}"
            )
        limits = {self.take(): self._limit() for _ in range(2) if self.here in ("_", "^")}
        if limits.keys() != {"_", "^"}:
            raise FormulaError(rf"expected both limits after \int: {_PLAIN}")
        self.integrals[-1] += 1
        inside = "1" if self.here == "d" else self.sum()
        if self.here != "d":
            raise FormulaError(rf"expected the differential at the end of \int: {_PLAIN}")
        self.take("d")
        self.integrals[-1] -= 1
        return f"Integral({inside}, ({self.primary()}, {limits['_']}, {limits['^']}))"

    def _limit(self) -> str:
        for signs in ([], ["-"], ["+"]):
            for limit in ([*signs, r"\infty"], ["{", *signs, r"\infty", "}"]):
                if self._next(len(limit)) == limit:
                    self.position += len(limit)
                    return "".join((*signs, "oo"))
        return self.bracket() if self.here == "{" else self.single()

    def _root(self) -> str:
        if self.here == "[":
            degree = self.bracket()
            return f"({self.bracket()})**(1/({degree}))"
        return f"sqrt({self.bracket() if self.here == '{' else self.single()})"

    def _function(self, name: str) -> str:
        """Return a function with its power, if any, and its argument."""
        base = ""
        if name == "log" and self.here == "_":
            self.take()
            base = f"/log({self.single()})"
        exponent = self.exponent() if self.here == "^" else None
        if exponent == "-1" and _INVERTIBLE.fullmatch(name):
            raise FormulaError(
                rf"\{name}^{{-1}} may be 1/{name} or the inverse function: "
                rf"write \frac{{1}}{{\{name}(...)}} or \operatorname{{arc{name}}}(...)"
            )
        applied = f"{name}({self._argument(name)}){base}"
        return applied if exponent is None else f"({applied})**({exponent})"

    def _argument(self, name: str) -> str:
        """Return a function's argument: in brackets, or one symbol, fraction or root.

        It may have numbers in front of it; of longer products the end would be ambiguous.
        """
        if self.here in _BRACKETS:
            return self.bracket()
        parts = []
        while (self.here or "").isdecimal() or self.here == r"\pi":
            parts.append(self.factor())
        if not (parts and (self._at_end() or self._is_function())):
            parts.append(self.factor())
        if not (self._at_end() or self._is_function()):
            raise FormulaError(
                rf"expected brackets or braces around the argument of \{name}, "
                f"got {self.here!r} after it: add them"
            )
        return "*".join(parts)

    def _is_function(self) -> bool:
        return (self.here or "").removeprefix("\\") in _FUNCTIONS and len(self.here or "") > 1

    def _symbol(self, name: str) -> str:
        if self.here == "_":
            self.take()
            name = f"{name}_{self._index()}"
        if name in ("J_0", "J_1", "I_0", "I_1"):
            return self._bessel(name.replace("_", ""))
        self._pass_index()
        arguments = ["(", *" , ".join((self.applied or {}).get(name, ())).split(), ")"]
        if len(arguments) > 2 and self._next(len(arguments)) == arguments:
            self.position += len(arguments)
        if name in self.preferred:
            return self.preferred[name]
        return name if name in self.allowed else self.vocabulary.name_of_latex.get(name, name)

    def _index(self) -> str:
        """Return a subscript; letters and digits in braces are one name."""
        if self.here != "{":
            return self.single()
        self.take()
        parts = []
        while self.here != "}":
            token = self.take()
            parts.append(_GREEK.get(token, token))
            if not parts[-1].isalnum():
                raise FormulaError(
                    f"expected letters and digits in a subscript, got {token!r}: leave it out"
                )
        self.take()
        return "".join(parts)

    def _refuse_unknown_function(self, name: str) -> None:
        """Reject a symbol before symbols in brackets, which would be read as a product."""
        if self.here in ("(", "[") and (
            arguments := _ARGUMENTS.match(" ".join(self.tokens[self.position :]))
        ):
            inside = arguments[1].replace(" ", "")
            raise FormulaError(
                f"expected a symbol or a known function, got {name}({inside}), which would be "
                f"read as a product: leave out ({inside}), or write the product without brackets"
            )

    def _pass_index(self) -> None:
        """Skip the index of a summed formula's term, as in ``C_1^{(j)}``."""
        if self._next(5) in (["^", "{", "(", i, ")"] for i in self.vocabulary.indices):
            self.position += 5
            self.take("}")

    def _next(self, count: int) -> list[str]:
        return self.tokens[self.position : self.position + count]

    def _bessel(self, name: str) -> str:
        if self.here == "^":
            exponent = self.exponent()
            applied = f"{name}({self.bracket()})" if self.here in ("(", "[") else name
            return f"({applied})**({exponent})"
        return f"{name}({self.bracket()})" if self.here in ("(", "[") else name
