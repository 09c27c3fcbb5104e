"""Mass over initial mass."""

from pyrofit.quantities.base import Quantity, Shown


def _guess(first: float, largest: float) -> str:
    if 0.9 < first < 1.1 and largest <= 1.5:
        return "1"
    return "%" if 95.0 < first < 105.0 else "mg"


QUANTITY = Quantity(
    kinds=("tga", "dsc"),
    title="mass fraction",
    symbol="m/m0",
    unit="-",
    column="mass_fraction",
    uncertainty_column="mass_fraction_uncertainty",
    shown=Shown("–"),
    scales=("fraction", "mass"),
    headers=("Mass fraction", "Mass", "Normalized mass", "Normalised mass"),
    uncertainty_headers=("Mass fraction error", "Mass error"),
    pattern=r"(norm\w*|residual|relative|abs(olute)?|(un)?subtracted)?(sample)?"
    r"(mass|weight)(?!loss|flux|flow).*"
    r"|masse|gewicht|m(rel\w*)?|tga?(corr\w*)?|w|y",
    guess=_guess,
    largest=(0.5, 1.5),
    against_temperature=True,
    # The error of a TGA is below 1e-6.
    solver_error=1e-5,
    usual_sd=0.02,
    # ASSUME: buoyancy and drift of a balance leave 0.3 % of the initial mass; thermocouples of one
    # apparatus repeat to 1 K.
    drift=0.003,
    temperature_error_K=1.0,
    # Between the scatter of laboratories as measured and with aligned temperatures; points scatter
    # far less (docs/identification.md).
    discrepancy=0.02,
)
