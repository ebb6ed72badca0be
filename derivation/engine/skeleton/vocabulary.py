"""The paper's symbols."""

import sympy as sp

from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

z = sp.Symbol("z", real=True)
k, H, G, s, T = sp.symbols("k H G s T", positive=True)
nu = sp.Symbol("nu", real=True)

FILM = Vocabulary(
    (
        Argument(z, "m", "z", "height above the base", ("z >= 0", "z <= H")),
        Argument(k, "1/m", "k", "wave number of the pressure", ("k >= 1e-100",)),
        Argument(H, "m", "H", "thickness of the film", ("H >= 1e-100",)),
        Argument(G, "Pa", "G", "shear modulus", ("G >= 1e-100",)),
        Argument(s, "1", "s", "compressibility, 1 - 2 nu", ("s >= 1e-100", "s < 3")),
        Argument(T, "1", "T", "wave number times twice the thickness, 2 k H", ("T >= 1e-100",)),
    ),
    guests=(Argument(nu, "1", r"\nu", "Poisson's ratio", ("nu > -1", "nu < 0.5")),),
    values={
        "z": "0.001",
        "k": "500",
        "H": "0.002",
        "G": "1e6",
        "s": "0.4",
        "T": "2",
    },
)


class Formula(Record):
    """A proved formula of the film."""

    vocabulary = FILM
