"""Impacts on plates by three-dimensional elastodynamics: an independent reference.

A rigid sphere strikes an axisymmetric elastic plate. Finite elements of high degree in r and z,
generalised-alpha time integration and Signorini conditions on the nodes of the contact face;
there are no modes and no contact law here, and nothing is taken from `derivation.scene`.

Read in this order:

1. `mesh`: element boundaries, graded towards the contact.
2. `plate`: material, edge, matrices; static contact and natural frequencies.
3. `impact`: the sphere, time steps, contact forces, results.
4. `cases`: which impacts and which plates are computed.
5. `record`: each case on several meshes and time steps, with error estimates; the record.

`python -m derivation.checks.finite_elements` computes what is missing from
`reports/data/elastodynamics.json`.
"""
