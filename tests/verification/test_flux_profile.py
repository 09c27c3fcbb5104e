"""A flux that differs over the radius, against a fine quadrature over rings of equal area."""

import numpy as np
import pytest
from cases import paper_experiment, paper_material, rms_over_mean, run

from pyrofit.effects.base import changed
from pyrofit.model.slab_faces import FluxProfile
from pyrofit.solver.curves import Request

RADIUS_M, RELATIVE = (0.0, 0.02, 0.035), (1.0, 0.98, 0.9)
RINGS = 60


def test_parabolic_profile_is_a_spread_beside_a_level() -> None:
    # Equal areas of a disc share the squares of its radii equally. Measured: 3.6e-5 and 0.014 K.
    fall, radius = 0.1, np.linspace(0.0, 0.035, 200)
    shares = 1.0 - fall * (radius / radius[-1]) ** 2
    profile = FluxProfile(radius_m=tuple(radius), relative_flux=tuple(shares))
    given = paper_experiment(50.0)
    time = np.arange(2.5, 900.0, 5.0)
    requests = {"mlr": Request(time, 5.0), "back_temperature": Request(time)}
    keys = ({"profile": profile}, {"spread": fall / (2.0 - fall), "flux_factor": 1.0 - fall / 2.0})
    one, other = (
        run(
            given.model_copy(update={"front": changed(given.front, **of)}),
            paper_material(),
            requests,
        ).signals
        for of in keys
    )
    assert rms_over_mean(one["mlr"], other["mlr"]) <= 1e-3
    assert one["back_temperature"] == pytest.approx(other["back_temperature"], abs=0.5)


def test_profile_agrees_with_sixty_rings() -> None:
    # Measured: 0.8 % of the mean rate and 1.1 K; with the flux of the middle 38 % and 117 K.
    # The burn-out of 5 rings smears the collapse of the rate less smoothly than that of 60.
    given = paper_experiment(50.0)
    time = np.arange(2.5, 900.0, 5.0)
    requests = {"mlr": Request(time, 5.0), "back_temperature": Request(time)}
    profile = FluxProfile(radius_m=RADIUS_M, relative_flux=RELATIVE)
    ours = run(
        given.model_copy(update={"front": changed(given.front, profile=profile)}),
        paper_material(),
        requests,
    ).signals
    area = (np.arange(RINGS) + 0.5) / RINGS
    shares = np.interp(RADIUS_M[-1] * np.sqrt(area), RADIUS_M, RELATIVE)
    fine = []
    for share in shares.tolist():
        front = changed(given.front, flux_W_m2=50e3 * share)
        ring = given.model_copy(update={"front": front})
        fine.append(run(ring, paper_material(), requests).signals)
    mlr, back = (np.mean([c[name] for c in fine], axis=0) for name in requests)
    centre = run(given, paper_material(), requests).signals
    assert rms_over_mean(centre["mlr"], mlr) > 0.3
    assert ours["back_temperature"] == pytest.approx(back, abs=2.0)
    assert rms_over_mean(ours["mlr"], mlr) <= 0.012
