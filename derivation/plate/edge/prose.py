"""What the report says of supported and clamped edges, by link."""

ABOUT = {
    "edge": "The paper's edge is elastically restrained: $w = 0$ and "
    r"$\sigma_{rr} = -2 \mu u/b$, in plate theory a rotational spring of stiffness "
    r"$(1 - \nu) D/b$. A simple support takes its force and moment away, by the exact "
    "states of stretching and bending; $w = 0$ at the edge of the middle plane. The "
    "sums over the modes are residues. A clamp, $u = w = 0$ on the whole edge, also "
    "forbids the plate's thinning there: by Betti's theorem the work of the load on the "
    "bending state gives the turn that the clamp takes away, and two constants of a "
    "clamped strip, measured by finite elements and fitted, say how the edge turns and "
    "lifts.",
}
