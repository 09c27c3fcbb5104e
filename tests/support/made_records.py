"""Records of results with plain values."""

from pyrofit.results.identification import Channel
from pyrofit.results.kinetics import KineticsFit, Searched
from pyrofit.results.searches import End


def searched(values: dict[str, float], cost: float) -> KineticsFit:
    """Return searches of the kinetics that ended at the same values."""
    end = End(cost=cost, calls=9, at_bound=[], parameters=values)
    sceua = Searched(cost=cost, calls=99)
    return KineticsFit(
        cost=cost,
        parameters=values,
        optimiser="SCE-UA",
        seed=1,
        sceua=sceua,
        least_squares=[end],
    )


def noise_of(experiment: str, signal: str, *, points: int, sd: float, chi2: float) -> Channel:
    """Return the record of white noise."""
    return Channel(
        experiment=experiment,
        signal=signal,
        points=points,
        sd_median=sd,
        points_sd=sd,
        lasting_sd=0.0,
        lags=[],
        ar=0.0,
        splines=4,
        excess=1.0,
        whiteness=0.5,
        floors={},
        words=f"sd {sd:g}, uncorrelated",
        chi2=chi2,
    )
