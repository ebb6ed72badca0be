"""Text of the report about viscoelastic contacts, by derivation step."""

ABOUT = {
    "viscosity": "In a viscoelastic contact (Kuwabara-Kono) the indentation lags the force; "
    "$A_v$ is a retardation time. The contact dissipates a part of the kinetic "
    "energy. In the plane of the velocity and the root of the elastic energy the "
    "motion is a spiral, from which bounds of the effect follow.",
}
