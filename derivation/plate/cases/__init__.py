"""Hard cases of all subjects: families, laws they are judged by, special calls."""
