"""What the report says of the plate's links, and what the plate's derivation builds on."""

from pathlib import Path

from derivation.engine.report.references import References

FACTOR = "G"
"""The plate factor, by whose name it is called in formulas after its own link."""
REFERENCES = References(Path(__file__).with_name("references.toml"))
ABOUT = {
    "equilibrium": "One mode of the plate is u = g(z) phi J1(phi r), w = f(z) J0(phi r). Put into "
    "Hooke's law and the balance of forces it leaves two ordinary differential equations in z.",
    "mode shapes": "On exp(s z) the two equations are a 2x2 matrix; the roots of its determinant "
    "and their multiplicities give the solution space.",
    "stresses": "Hooke's law of the mode. The normal stresses in the plane have a second part "
    "that goes with J1(phi r)/r.",
    "face conditions": "No shear on either face, no pressure on the far face, A_j on the loaded "
    "one: four linear equations for C_k = A_j Omega_k.",
    "loaded mode": "The same shapes with the constants just found.",
    "influence": "The deflection of each face per pressure coefficient, and what remains of it "
    "when the plate becomes a half-space.",
    "plate factor": "The influence coefficients over the half-space's depend on T = 2 phi h alone.",
    "Hertz": "Hertz's pressure, its transform (Sonine's integral) and the contact radius, which "
    "follows from the half-space's influence coefficient.",
    "contact law": "The indentation is the deflection under the sphere's centre.",
    "interior": "Sums over the modes give the fields at any point.",
    "divergence": "For large j the modes feel a half-space: phi^3 K_j tends to a constant, and the "
    "sums in the paper's gamma_k diverge for every k.",
    "contact split": "A contour integral turns the sum for the indentation into Hertz's term, the "
    "side wall's integral and a sum that dies exponentially with the thickness.",
    "plate series": "For small contacts the two convergent parts are expanded in powers of the "
    "contact radius; the coefficients depend on h/b alone.",
    "thin plate": "For thin plates the sums become integrals over T, with finite parts M_k and a "
    "logarithm. What they leave out is a sum of residues at T_n, the roots of sinh T = T and "
    "sinh T = -T in the first quadrant, by height. With it the law is exact for every h/b.",
    "reversion": "Lagrange's inversion, of the paper's series and of the right one.",
    "impact": "The energy integral, the contact time as an integral of an analytic function, and "
    "the paper's linearisation.",
    "sensitivity": "An impact depends on seven parameters through two numbers, its energy number "
    "and h/b, beside plain powers. What these two do to peaks and contact time follows from the "
    "energy integral; the rest is exponents.",
    "substitution": "If the law's slope lies within known factors of a simpler one's, so do an "
    "impact's results. It lies between S_1 = 1 + 3 c_1 A/2 and S_1 - K_3 A^3 for every a < b, so "
    "that Hertz's law, and its first correction, know their own error.",
    "edge": "The paper's edge is elastically restrained: w = 0 and sigma_rr = -2 mu u/b, in "
    "plate theory a rotational spring of stiffness (1 - nu) D/b. A simple support "
    "takes its force and moment away, by the exact states of stretching and bending; w = 0 on the "
    "middle plane's rim. The sums over the modes are residues. A clamp, u = w = 0 on the whole "
    "edge, also forbids the plate's thinning there: by Betti's theorem the work of the load on "
    "the bending state gives the turn that the clamp takes away, and two constants of a clamped "
    "strip, measured by finite elements and fitted, say how the edge turns and lifts.",
    "true pressure": "Not assumed but solved for: the pressure is Abel's transform of chi(t), and "
    "chi(t) + int N(t, s) chi(s) ds = (E*/pi) (delta - f(t)) on (0, a), where f belongs to the "
    "sphere's profile and N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2b). The kernel k is the slope "
    "by a/b of S = (R/2a) d delta/da of Hertz's pressure; chi(a) = 0 fixes delta. Last, a bound "
    "of what assuming Hertz's pressure changes at given force, a being Hertz's radius of it.",
    "curvature": "A growing contact is a sequence of flat punches. Where it is not small beside "
    "the sphere the paraboloid gives way to the sphere's own profile.",
    "effects": "Each effect adds a share to the law's slope at equal force. What it can add at "
    "most says whether a scene needs it.",
    "plate motion": "The law is static. These numbers say when the plate's own motion matters.",
    "viscosity": "In a viscoelastic contact (Kuwabara-Kono) the indentation lags the force; A_v is "
    "a retardation time. The contact dissipates a part of the kinetic energy. In the plane of the "
    "velocity and the root of the elastic energy the motion is a spiral, which says how much at "
    "most.",
    "far face": "A plate breaks where it is drawn most: on the far face, under the axis. What its "
    "modes add up to there is, of a thin plate, a function of a/h and a logarithm of b/h; the "
    "edge's states of stretching and bending add their own stress.",
    "dynamic modes": "The first six links again, with the plate's own inertia. A load that "
    "oscillates bends and stretches the plate apart, with stiffnesses B_a and B_s: x = phi h, "
    "kappa = (omega h/c_T)^2, gamma = mu/(lambda + 2 mu), p^2 = x^2 - gamma kappa, q^2 = x^2 - "
    "kappa. Both fall with the frequency where they are finite, by the motion's kinetic energy, so "
    "that between two poles of either there is one branch of free waves; these are orthogonal.",
    "bending branch": "Below the speed of shear waves B_a vanishes once: on A0, the lowest branch. "
    "For thin plates it is Kirchhoff's bending and carries the whole load, for short waves it is "
    "Rayleigh's wave. Its share y of the face's deflection obeys y'' + omega_0^2 y = r_0 A_j. Here "
    "xi = kappa/x^2 and w = 1 - xi.",
    "closure": "A plate that moves is a set of oscillators q_j of static compliance c_j, and each "
    "feels only the part P_j of the force. With z = D + sum s_j q_j, s_j = dP_j/dP and D = delta - "
    "sum c_j P_j s_j no energy is lost or made, whatever the static law: int P dD + sum q_j (P s_j "
    "- P_j) is the contact's. With s_j = 1, the indentation at the axis, some leaks. The same "
    "weight turns the static law into the variational one.",
    "held modes": "A thin plate's modes J0(k r/b) - c I0(k r/b) whose edge has no slope, or no "
    "moment. Green's identity makes them orthogonal, and makes (J1/J0 + I1/I0)/k grow from one "
    "zero of J0 to the next, so that there is one mode between neighbouring ones. W_n says how a "
    "force on the axis moves it: the sum of W_n/k_n^4 is the deflection at rest.",
    "held waves": "A plate with a thickness keeps the frequency and residue of A0 at its wave "
    "number; its edge is Mindlin's, whose shear coefficient makes his lower branch follow A0 to "
    "one more order. A mode is J0(k r/b) - c I0(k_2 r/b), psi is its rotation, t is by how much "
    "more the part I0 moves the loaded face. Below the cut-off k_2 = 0 one mode lies between "
    "neighbouring zeros of J0 (proved for Mindlin's frequencies, tested with those of A0). The "
    "clamp's compliance 0.09 (nu/(1 - nu))^2 h/b is measured on finite elements, not derived.",
}
