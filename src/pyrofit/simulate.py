"""Curves of an experiment for given parameter values, for one set of them or for many at once."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from pyrofit.model.accuracy import Accuracy
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.parallel import spare
from pyrofit.solver.arrays import FLUX, Description, FloatArray, Numerics, Values
from pyrofit.solver.backing import lower_backing, with_backing
from pyrofit.solver.curves import Curves, Request, Runs
from pyrofit.solver.heated import heated_samples
from pyrofit.solver.lower import Substance
from pyrofit.solver.lower_experiment import lower_layers, lower_places, lower_share
from pyrofit.solver.lower_exposure import lower_exposure, number_of_sets
from pyrofit.solver.observe import observe
from pyrofit.solver.run import Case, repeated_case, run_kernel


def simulate_tga(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy | None = None,
) -> Curves:
    """Simulate an experiment whose sample follows a temperature programme.

    Parameters
    ----------
    experiment, material
        The description.
    values
        Parameter values in SI units by name.
    request
        Times [s] and temperatures [K], shape (points,), increasing times.
    accuracy
        Numerical settings.

    Returns
    -------
    Curves
        Signals ``mass_fraction`` [-] and ``mass_loss_rate`` [1/s] at the times; ``heat_flow`` or
        ``specific_heat_release_rate`` [W/kg] where it is the output of the request.
    """
    return simulate_tgas([experiment], material, values, [request], accuracy)[0][0]


def simulate_tgas(
    experiments: Sequence[HeatedExperiment],
    material: Material,
    values: Values,
    requests: Sequence[Request],
    accuracy: Accuracy | None = None,
    sets: int = 1,
) -> list[list[Curves]]:
    """Simulate such experiments for many parameter sets, all in one call of the solver.

    As `simulate_tga`, with a request for each experiment; each value is a number or has the shape
    (sets,). The curves are listed by experiment, then by set.
    """
    accuracy = accuracy or Accuracy()
    wanted = [{request.output} for request in requests]
    step = accuracy.tga_step_K
    return heated_samples(experiments, material, values, requests, wanted, step, sets)


def simulate_gasification(
    experiment: SlabExperiment,
    material: Material,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
) -> Curves:
    """Simulate a gasification experiment.

    Parameters
    ----------
    experiment, material
        The description.
    values
        Parameter values in SI units by name.
    requests
        By signal: ``mlr`` [kg/(m2 s)], averaged over the bin width; ``mass`` [kg/m2],
        ``back_temperature``, ``front_temperature`` [K], ``thickness`` [m], and
        ``inside_temperature`` [K] at the place of the request.
    accuracy
        Numerical settings.

    Returns
    -------
    Curves
        The signals at their times, empty unless the run finished. MLR over a bin is the
        difference of the released mass, so that mass closes to round-off.
    """
    return simulate_gasifications(experiment, material, values, requests, accuracy)[0]


def simulate_gasifications(
    experiment: SlabExperiment,
    material: Material,
    values: Values,
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
    sets: int = 1,
    threads: int = 1,
) -> list[Curves]:
    """Simulate a gasification experiment for many parameter sets.

    As `simulate_gasification`; each value is a number or has the shape (sets,). A set has the same
    curves to the last bit alone and among others, with one thread and with several.
    """
    substance = Substance(material, values, sets)
    return _simulated(experiment, substance, requests, accuracy or Accuracy(), threads)


def simulate_slabs(
    experiments: Sequence[SlabExperiment],
    material: Material,
    values: Values,
    asked: Sequence[Mapping[str, Request]],
    accuracy: Accuracy,
    sets: int = 1,
    led: bool = False,
) -> list[list[Curves]]:
    """Simulate such experiments of one material; the curves are listed by experiment, then set.

    In as many threads as processes would be idle otherwise. Where the sets are ``led``, all take
    the cells and time steps of the first one, and lose cells and burn out with it. Its curves are
    those that it has alone. Differences from it are smooth in the parameters, but the error control
    is that of the first one.
    """
    substance = Substance(material, values, sets)
    return [
        _simulated(experiment, substance, requests, accuracy, 1 + spare(), led)
        for experiment, requests in zip(experiments, asked, strict=True)
    ]


def _simulated(
    experiment: SlabExperiment,
    substance: Substance,
    requests: Mapping[str, Request],
    accuracy: Accuracy,
    threads: int = 1,
    led: bool = False,
) -> list[Curves]:
    values, sets = substance.values, substance.sets
    block = sets if led and sets > 1 else 0
    case = lowered(experiment, substance.of(experiment.sample), accuracy)
    located = lower_places(experiment.sample, requests, values, sets)

    def run(factors: FloatArray | None, asked: Mapping[str, Request]) -> Runs:
        if factors is None:
            return run_kernel(case, asked, _numerics(accuracy), threads, block)
        runs = repeated_case(case, factors.size // sets)
        exposure = runs.description.exposure
        schedule = exposure.schedule.copy()
        schedule[FLUX] *= factors
        exposed = runs.description._replace(exposure=exposure._replace(schedule=schedule))
        runs = runs._replace(description=exposed)
        return run_kernel(runs, asked, _numerics(accuracy), threads, block)

    return observe(experiment, values, located, run, sets).curves()


def _numerics(accuracy: Accuracy) -> Numerics:
    """Return the settings as the kernel takes them."""
    return Numerics(
        accuracy.tolerance, accuracy.first_step_s, accuracy.longest_step_s, accuracy.most_steps
    )


def lowered(experiment: SlabExperiment, substance: Substance, accuracy: Accuracy) -> Case:
    """Return an experiment on a slab as arrays for the kernel, a row for each set of values."""
    sample = experiment.sample
    material, values, sets = substance.material, substance.values, substance.sets
    properties = substance.properties(sample)
    network = substance.network(experiment.oxygen)
    share = lower_share(experiment, material, values, sets)
    exposure = lower_exposure(experiment, share, properties, values, sets)
    layers = lower_layers(experiment, material, properties, values, sets, share)
    factor = accuracy.cells_factor
    backing = lower_backing(experiment, material, properties, values, sets, factor)
    exposure = with_backing(exposure, backing)
    T_start = number_of_sets(value_of(sample.initial_temperature_K, values), sets)
    if accuracy.cells is None:
        from pyrofit.solver.kernels.grid import cells_needed

        thickness = np.asarray(sum(layer.thickness for layer in layers if not layer.added))
        needed = cells_needed(share, thickness, T_start, properties, network, exposure)
        needed = np.minimum(needed, accuracy.most_cells)
        cells = np.ceil(accuracy.cells_factor * needed).astype(np.int64)
    else:
        cells = np.full(sets, accuracy.cells)
    return Case(layers + backing, cells, T_start, Description(properties, network, exposure))


def solver_errors(
    coarse: Curves, fine: Curves, requests: Mapping[str, Request]
) -> dict[str, float]:
    """Estimate the solver's own error of a run from a finer one, with `Accuracy.refined`.

    With twice the cells and half the steps both errors, of second order, are a quarter; so the
    error is 4/3 of the difference (Richardson).

    Returns
    -------
    dict
        Root mean square of the error by signal, in its SI unit; NaN where a run did not finish.
    """
    if not (coarse.status.finished and fine.status.finished):
        return dict.fromkeys(requests, math.nan)
    return {
        name: 4.0 / 3.0 * float(np.sqrt(np.mean((coarse.signals[name] - curve) ** 2)))
        for name, curve in fine.signals.items()
    }
