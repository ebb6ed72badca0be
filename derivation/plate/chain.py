"""The derivation: its steps in order, and every formula by name.

The `STEPS` of the subjects' theory follow at the end.

 1 equilibrium      Hooke's law, force balance -> ODEs for f_j, g_j
 2 mode shapes      ODEs -> general solution (2)
 3 stresses         Hooke's law of the mode
 4 face conditions  tractions (3) -> Omega_1 ... Omega_4 (5)
 5 loaded mode      f_j, g_j and stresses with the constants of (5)
 6 influence        w on both faces, half-space limit
 7 plate factor     the same as G(T), G_m(T), T = 2 phi h
 8 Hertz            pressure and its radius (7), Sonine's integral, A_j (4), (8)
 9 contact law      K_j, delta (6)
10 interior         u, w and stresses at any (r, z)

and from the contact law to the motion:

11 divergence       phi^3 K_j -> 4/(R b): the paper's gamma_k diverge
12 contact split    delta = a^2/R + finite radius + finite thickness
13 plate series     small contacts: c_1, c_3, ..., gamma_k without their divergent part
14 thin plate       the same for h/b -> 0, and a sum over roots that makes it exact
15 reversion        force as a function of indentation: xi_k (10), p_n
16 impact           energy integral (13), contact time, linearisation (15) to (18)
17 sensitivity      slopes of the law; derivatives of an impact with respect to each parameter
18 substitution     change of an impact if its law is replaced by a simpler one
19 edge             simply supported or clamped edge instead of the paper's edge
20 contact pressure non-Hertzian pressure: integral equation, and the error of Hertz pressure
21 spherical profile exact sphere instead of a paraboloid
22 effects          bounds of the change of the law by each effect
23 plate motion     criteria for plate inertia: Zener's parameter, periods
24 viscosity        viscoelastic contact: restitution, and bounds of the change
25 back face        largest tensile stress, on the back face opposite the contact
26 dynamic modes    steps 1 to 6 with plate inertia: influence at any frequency
27 bending branch   lowest Lamb-wave branch A0: frequency, residue, limits
28 coupling         coupling of contact and modes that conserves energy
29 thin-plate modes bending modes of a clamped or simply supported plate
30 thick-plate modes the same for finite thickness: Mindlin's edge conditions, branch A0
31 plasticity       elastic-plastic contact: limited pressure, unloading, residual indentation
32 damping          damped modes: response, free motion, dissipated energy
33 stretching       stiffening of a plate whose middle plane stretches
34 wave stress      stress of waves and modes on the back face
35 finite sphere    compliance of a sphere, and motion of both faces, to first order in a/R
"""

from collections.abc import Callable

from derivation.engine.cache import in_file
from derivation.engine.formula.proof import Proof
from derivation.plate.back_face.theory import back_face_formulas
from derivation.plate.contact.theory.divergence import divergence
from derivation.plate.contact.theory.hertz import (
    SOURCES,
    contact_radius,
    pressure,
    pressure_coefficient,
    sonine,
)
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.contact.theory.plate_series import series_formulas
from derivation.plate.contact.theory.reversion import reversion
from derivation.plate.contact.theory.spherical_profile import spherical_profile
from derivation.plate.contact.theory.split import contact_split, reduced_split
from derivation.plate.contact.theory.thin_plate import thin_plate
from derivation.plate.contact.theory.thin_remainder import thin_remainder
from derivation.plate.edge.theory.clamped import clamp
from derivation.plate.edge.theory.curvature import edge_curvature
from derivation.plate.edge.theory.sums import edge_sums
from derivation.plate.edge.theory.supported import edge
from derivation.plate.effects.theory import effects
from derivation.plate.impact.theory.impact import impact
from derivation.plate.impact.theory.sensitivity import sensitivity
from derivation.plate.impact.theory.substitution import substitution
from derivation.plate.modes.theory.equilibrium import equilibrium
from derivation.plate.modes.theory.face_conditions import omegas, scaled_omegas
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.modes.theory.interior import interior_fields
from derivation.plate.modes.theory.loaded_mode import loaded_mode
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.modes.theory.plate_factor import plate_factor_slope, plate_factors
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.pressure.theory.integral_equation import non_hertzian_pressure
from derivation.plate.pressure.theory.waves import force_of_wave
from derivation.plate.sphere.theory import finite_sphere
from derivation.plate.subjects import exports
from derivation.plate.viscosity.theory.bounds import viscosity
from derivation.plate.vocabulary import Formula
from derivation.plate.waves.theory.bending_branch import bending_branch
from derivation.plate.waves.theory.coupling import coupling
from derivation.plate.waves.theory.dynamic_modes import dynamic_modes
from derivation.plate.waves.theory.plate_motion import plate_motion
from derivation.plate.waves.theory.wave_stress import wave_stress

Step = tuple[str, Callable[[], tuple[Formula, ...]]]

STEPS: tuple[Step, ...] = (
    ("equilibrium", equilibrium),
    ("mode shapes", mode_shapes),
    ("stresses", modal_stresses),
    ("face conditions", lambda: (*omegas(), *scaled_omegas())),
    ("loaded mode", loaded_mode),
    ("influence", influence_coefficients),
    ("plate factor", lambda: (*plate_factors(), plate_factor_slope())),
    ("Hertz", lambda: (pressure(), sonine(), contact_radius(), pressure_coefficient())),
    ("contact law", contact_law),
    ("interior", interior_fields),
)
MOTION_STEPS: tuple[Step, ...] = (
    ("divergence", divergence),
    ("contact split", lambda: (*contact_split(), *reduced_split())),
    ("plate series", series_formulas),
    ("thin plate", lambda: (*thin_plate(), *thin_remainder())),
    ("reversion", reversion),
    ("impact", impact),
    ("sensitivity", sensitivity),
    ("substitution", substitution),
    ("edge", lambda: (*edge(), *edge_sums(), *clamp())),
    ("contact pressure", lambda: (*non_hertzian_pressure(), *edge_curvature(), force_of_wave())),
    ("spherical profile", spherical_profile),
    ("effects", effects),
    ("plate motion", plate_motion),
    ("viscosity", viscosity),
    ("back face", back_face_formulas),
    ("dynamic modes", dynamic_modes),
    ("bending branch", bending_branch),
    ("coupling", coupling),
    *(step for steps in exports("theory", "STEPS") for step in steps),
    ("wave stress", wave_stress),
    ("finite sphere", finite_sphere),
)
"""Steps after the contact law. They are separate, because they contain integrals and constants."""


@in_file((*SOURCES, "plate/chain.py"), Formula, Proof)
def derive() -> dict[str, Formula]:
    """Return every formula up to the interior by name, each proved.

    Raises
    ------
    ProofError
        Naming the step whose proof fails.
    """
    return {formula.name: formula for _, step in STEPS for formula in step()}
