"""Text of the report about supported and clamped edges, by derivation step."""

ABOUT = {
    "edge": "The paper's edge is elastically restrained: $w = 0$ and "
    r"$\sigma_{rr} = -2 \mu u/b$, in plate theory a rotational spring of stiffness "
    r"$(1 - \nu) D/b$. A simple support removes its force and moment by the exact "
    "states of extension and bending, with $w = 0$ at the edge of the middle plane. The "
    "sums over the modes are sums of residues. A clamp, $u = w = 0$ on the whole edge, also "
    "prevents thinning of the plate there. By Betti's theorem, the work of the load on the "
    "bending state gives the rotation that the clamp suppresses. Two constants of a clamped "
    "strip, computed by finite elements and fitted, describe how the edge rotates and "
    "deflects.",
}
