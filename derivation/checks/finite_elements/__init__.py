"""Impacts on plates by three-dimensional elastodynamics: an independent reference.

A rigid sphere strikes an axisymmetric elastic plate. The solution uses finite elements of high
degree in r and z, generalised-alpha time integration, and Signorini conditions at the nodes of the
contact face. It uses neither modes nor a contact law, and no code of `derivation.scene`.

Read in this order:

1. `mesh`: element boundaries, graded towards the contact.
2. `plate`: material, edge, matrices; static contact and natural frequencies.
3. `impact`: the sphere, time steps, contact forces, results.
4. `cases`: which impacts and which plates are computed.
5. `record`: solutions of each case on several meshes and with several time steps, with error
   estimates; the record.

`python -m derivation.checks.finite_elements` computes the cases that are missing from
`reports/data/elastodynamics.json`, or that were computed with other code.
"""
