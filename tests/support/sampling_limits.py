"""The sampling limits of the paper."""

import numpy as np

TABLE_6 = np.array(
    [
        (600.0, 1500.0),
        (0.09, 0.35),
        (875.0, 2725.0),
        (0.01, 0.99),
        (250e3, 1550e3),
        (500.0, 1500.0),
        (0.09, 0.55),
        (500.0, 2000.0),
        (0.01, 0.99),
    ]
)
"""Sampling limits in the order of ``NAMES``, SI units."""
