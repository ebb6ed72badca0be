"""Constants for the generated code of the impact."""

import numpy as np

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.plate.budgets import read_stated_limits
from derivation.plate.contact.kernels.tables import IMPACT_NODES, INNER_NODES, gauss_legendre


def impact_numbers() -> Numbers:
    """Return Gauss' rules, and the error budgets of contact time and rounding."""
    (nodes, weights), (inner_nodes, inner_weights) = (
        tuple(np.array(part) for part in gauss_legendre(count))
        for count in (IMPACT_NODES, INNER_NODES)
    )
    stated = read_stated_limits()
    return Numbers(
        "impact_numbers",
        "Constants of the impact: Gauss' rules on [0, 1], and error budgets.",
        (
            Constant("NODES", nodes, "Gauss-Legendre nodes of the integral over the impact."),
            Constant("WEIGHTS", weights, "Their weights."),
            Constant(
                "INNER_NODES",
                inner_nodes,
                "Fewer nodes, for the range beyond the first polynomial, and for coarse times.",
            ),
            Constant("INNER_WEIGHTS", inner_weights, "Their weights."),
            Constant(
                "COARSE_QUADRATURE",
                stated["coarse_quadrature"],
                "Relative error of a contact time by half the nodes: tested, not proved.",
            ),
            Constant(
                "FULL_QUADRATURE",
                stated["full_quadrature"],
                "Relative error of a contact time by all nodes: tested, not proved.",
            ),
            Constant(
                "ROUNDING",
                stated["rounding"],
                "Relative error of all results by rounding, also of the law's tables: tested.",
            ),
        ),
    )
