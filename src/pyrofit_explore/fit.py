"""Least squares from the values of a page over the parameters that are ticked there."""

import time
from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np

from pyrofit.api.choices import in_units
from pyrofit.config import calibration_channels
from pyrofit.errors import StudyError
from pyrofit.estimate.bounded_least_squares import minimise
from pyrofit.estimate.likelihood import ENOUGH, Likelihood
from pyrofit.estimate.pose import of_diagnosis, pose
from pyrofit.estimate.prior import prior_of
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray
from pyrofit_explore.noise import Noise
from pyrofit_explore.session import Session, State

EVERY_S = 0.3
"""Least time between two messages."""
Send = Callable[[Mapping[str, Any]], None]
"""Sends a message to the page; raises if it is gone, or has cancelled the fit."""


def descend_and_tell(session: Session, state: State, ticked: Collection[str], send: Send) -> None:
    """Descend from a state over the fitted signals; send messages, and the best values so far.

    Raises
    ------
    StudyError
        No parameter is ticked, a value lies outside its limits, no simulation finishes at the
        start, or the noise is not known.
    """
    noise = _noise(session, send)
    likelihood, x = _posed(session, state, ticked, noise)
    best, sent, lowest, calls = x, time.monotonic(), np.inf, 0

    def message(x: FloatArray, words: str) -> dict[str, Any]:
        names = likelihood.problem.names
        values = dict(zip(names, likelihood.values(x).tolist(), strict=True))
        study = session.model(state.effects).study
        text = f"{words}: χ² {lowest:.5g}, from {first:.5g}; {calls} simulations"
        return {"said": text, "values": in_units(study, values)}

    def residuals(x: FloatArray) -> FloatArray:
        nonlocal sent, lowest, calls, best
        r = likelihood.residuals(x)
        calls += 1
        chi2 = linear.dot(r, r)
        if chi2 < lowest:
            lowest, best = chi2, x
        if time.monotonic() - sent > EVERY_S:
            send(message(best, "The fit goes on"))
            sent = time.monotonic()
        return r

    if not likelihood.finished(start := likelihood.residuals(x)):
        raise StudyError("fit: a simulation of these values fails; start from others")
    first = linear.dot(start, start)
    idle = likelihood.problem.idle
    end = minimise(residuals, likelihood.jacobian, x, ENOUGH, idle=idle)
    lowest = end.chi2
    send(message(end.x, "The fit has ended"))


def _noise(session: Session, send: Send) -> Noise:
    pending = session.pending
    while session.noise is None:
        if pending is None or pending.error:
            why = pending.error if pending else "this page does not estimate it"
            raise StudyError(f"fit: the noise of the signals is not known: {why}")
        send({"said": "The noise of the signals is being estimated ..."})
        pending.wait(1.0)
    return session.noise


def _posed(
    session: Session, state: State, ticked: Collection[str], noise: Noise
) -> tuple[Likelihood, FloatArray]:
    """Return the likelihood of the ticked parameters, and the start as fractions of the limits."""
    model = session.model(state.effects)
    names = [name for name in model.problem.names if name in ticked]
    if not names:
        raise StudyError("fit: no parameter is ticked; tick those to estimate")
    values = session.values(model, state)
    study = model.study
    asked = of_diagnosis(study, calibration_channels(study), names)
    problem = pose(study, asked, session.measurements, values)
    likelihood = Likelihood(problem, noise, prior_of(study, problem))
    return likelihood, likelihood.scaled(np.array([values[name] for name in names]))
