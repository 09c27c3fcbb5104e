"""Radiation is absorbed in depth instead of at the surface, the transmitted part by the back."""

from pyrofit.effects.base import Effect, Numbers, Quantity, on
from pyrofit.effects.substance import refuse_translucent
from pyrofit.model.experiment import Experiment
from pyrofit.model.slab import SlabExperiment

LENGTH = Quantity(
    symbol="l",
    label="absorption length",
    unit="m",
    lower=0.0,
    upper=2e-3,
    value=0.0,
    typical=3.5e-4,
    source="MaCFP PMMA: kappa/rho = 2.38 m2/kg, groups use 2250 to 3421 1/m; "
    "Linteris et al. 2012, doi:10.1002/fam.1113",
)


def absorbed_behind(experiment: Experiment, at: Numbers, **takes: str) -> Experiment:
    """Return the experiment with keys of its sample set, and a back that absorbs transmission.

    Transmission that the description calls lost stays lost.
    """
    assert isinstance(experiment, SlabExperiment)
    lost = experiment.sample.transmitted == "lost"
    return on("sample", takes, **({} if lost else {"transmitted": "back"}))(experiment, at)


EFFECT = Effect(
    title="in-depth absorption",
    family="material",
    group="absorption in depth",
    equation="q''' = eps q exp(-z/l)/l; back face or foil absorbs eps q exp(-L/l)",
    strength={"length_m": LENGTH},
    material=refuse_translucent,
    experiment=lambda experiment, at: absorbed_behind(
        experiment, at, absorption_length_m="length_m"
    ),
    of_sample=True,
)
