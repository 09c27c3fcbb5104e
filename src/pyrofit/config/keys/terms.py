"""Terms of a cost, and the signals that they compare."""

from collections.abc import Iterable
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from pyrofit.cost import KINDS, NORMALISATIONS, check_cost_options
from pyrofit.errors import CostError, suggest
from pyrofit.model.base import Part
from pyrofit.quantities.base import LIMITS


class TermSpec(Part):
    """One cost of one signal, a term of Eq. 5."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="signal of the experiment")
    kind: str = Field(description="cost: " + ", ".join(KINDS) + ", or one of `plugins`")
    weight: float = Field(1.0, ge=0.0, description="weight w of Eq. 5")
    normalisation: str | None = Field(
        None, description="y_N of Table 1: " + ", ".join(NORMALISATIONS) + "; default: the cost's"
    )
    points: int | None = Field(
        None, ge=2, description="points the target is interpolated to; none = measured points"
    )
    window_s: tuple[float, float] | None = Field(None, description="compared time window [s]")
    limits: Literal["columns"] | None = Field(
        None,
        description="BANDS: 'columns' takes its limits from the columns lower and upper of the "
        "signal; none = value -+ n_sigma times its uncertainty",
    )
    options: dict[str, float] = Field(default_factory=dict, description="options of the cost")

    @model_validator(mode="after")
    def _check(self) -> Self:
        try:
            check_cost_options(self.kind, self.all_options())
        except CostError as error:
            raise ValueError(str(error)) from None
        if self.normalisation is not None and self.normalisation not in NORMALISATIONS:
            raise ValueError(
                f"unknown normalisation '{self.normalisation}'. "
                + suggest(self.normalisation, NORMALISATIONS)
            )
        if self.limits is not None:
            self._check_limits()
        if self.window_s is not None and self.window_s[0] >= self.window_s[1]:
            raise ValueError("window_s must be [start, end] with start below end")
        return self

    def _check_limits(self) -> None:
        """Refuse limits of a cost that takes none, or takes them from the uncertainty, too."""
        try:
            check_cost_options(self.kind, {**self.all_options(), **dict.fromkeys(LIMITS)})
        except CostError:
            raise ValueError(f"{self.kind} takes no limits; leave `limits` out") from None
        if "n_sigma" in self.options:
            raise ValueError("give `limits`, or `n_sigma` under options; not both")

    def all_options(self) -> dict[str, object]:
        """Return the options of the cost, the normalisation among them where it is given."""
        options: dict[str, object] = dict(self.options)
        if self.normalisation is not None:
            options["normalisation"] = self.normalisation
        return options


Terms = Annotated[tuple[TermSpec, ...], Field(min_length=1)]


def channels_of(terms: Iterable[TermSpec]) -> tuple[TermSpec, ...]:
    """Return the signals that some terms compare, each once, all measured points."""
    windows: dict[tuple[str, str], list[tuple[float, float] | None]] = {}
    for term in terms:
        if term.weight > 0.0:
            windows.setdefault((term.experiment, term.signal), []).append(term.window_s)
    return tuple(
        TermSpec(experiment=e, signal=s, kind="RMSE", window_s=_hull(found))
        for (e, s), found in windows.items()
    )


def _hull(windows: list[tuple[float, float] | None]) -> tuple[float, float] | None:
    """Return the window around all windows, None where one is the whole record."""
    given = [window for window in windows if window is not None]
    if len(given) < len(windows):
        return None
    return min(start for start, _ in given), max(end for _, end in given)
