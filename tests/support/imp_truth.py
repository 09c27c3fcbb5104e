"""The truth of the inverse modelling in tests."""

TRUTH = {"rho": 1190.0, "k": 0.2, "cp": 2100.0, "eps": 0.9, "dh": 800e3}
