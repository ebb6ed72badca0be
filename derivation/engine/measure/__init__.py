"""How wrong the generated functions are: hard points, errors in ULP, verdicts as data."""
