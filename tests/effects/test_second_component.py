"""A second component reacts beside the main one."""

import numpy as np
import pytest
from bases import Curve, having, pmma, run


def mass(share: float, **form: float) -> Curve:
    """Return the mass at 10 K/min over the initial one."""
    base = having(pmma(), {"second_component": {"share": share, **form}})
    slow = list(base.experiments)[2]
    return run(base, slow)[1][0]


def test_mass_is_linear_in_the_share_of_the_second_component() -> None:
    none, one, two = (mass(share) for share in (0.0, 0.2, 0.4))
    assert np.max(np.abs(one - none)) > 0.05
    assert two - none == pytest.approx(2.0 * (one - none), abs=1e-4)


def test_second_component_reacts_at_its_own_temperature() -> None:
    early, late = (mass(0.3, temperature_K=T) for T in (500.0, 740.0))
    assert np.all(early <= late + 1e-6)
    # The early one is gone before the main one begins.
    assert np.min(np.abs(early - 0.7)) < 0.01
    assert np.max(late - early) > 0.25
