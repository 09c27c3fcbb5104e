"""The diagnosis of a study: which effect its model lacks."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

from pyrofit.api import plots
from pyrofit.api.arguments import count_of, teller_of, wrong
from pyrofit.api.choices import Key, names_given
from pyrofit.api.measurements import Data, given_keys, read_to_fit
from pyrofit.api.studies import Source, read_study
from pyrofit.api.tables import html_page, text_table
from pyrofit.config import Study, as_study, calibration_channels, held_out_channels
from pyrofit.diagnose.diagnosis import DiagnosisWork as Found
from pyrofit.diagnose.diagnosis import examine
from pyrofit.diagnose.result.extended_study import extended_keys
from pyrofit.diagnose.settings import Settings
from pyrofit.errors import StudyError
from pyrofit.results.diagnosis_schema import Diagnosis as Record
from pyrofit.show.diagnosis.evidence import evidence_of
from pyrofit.show.diagnosis.ranking import draw_ranking, ranking_entries
from pyrofit.show.diagnosis.sentences import certainty, summary_sentences
from pyrofit.show.diagnosis.words import ranked, remark_on_candidate
from pyrofit.stages.diagnose import refuse_programs

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 8
"""Candidates that a printed diagnosis lists."""


def diagnose(
    study: Source,
    data: Data | None = None,
    *,
    effects: str | Sequence[str] | None = None,
    advise: bool = False,
    processes: int = 1,
    tell: Callable[[str], None] | None = None,
    settings: Settings = Settings(),
) -> "Diagnosis":
    """Find where model and measurements disagree, and which effect the model lacks.

    Parameters
    ----------
    study
        A study, its file, or its keys; the key ``diagnosis`` names fitted and held-out signals.
    data
        Measured series that replace those of the study, as of `read_data`.
    effects
        Names of the effects that are tried, by default all that can show; see `effects`.
    advise
        Whether to fit free corrections and to propose the next experiment as well; this takes
        about as long again.
    processes
        Processes that share the fits; the result does not depend on their number.
    tell
        Function that receives messages on the progress, such as ``print``.
    settings
        Numbers that steer the diagnosis, of `pyrofit.diagnose.settings`.

    Raises
    ------
    StudyError
        An effect is not known, or the model cannot be diagnosed.
    DataError
        A series is missing or too short, or no run within the limits finishes.

    Warns
    -----
    UserWarning
        A record is suspect, such as a mass that rises before it falls.
    """
    names = [effects] if isinstance(effects, str) else effects
    names = None if names is None else names_given("effects", names)
    if names is not None and not names:
        raise StudyError("no effect is named; leave `effects` out to try all that can show")
    count_of("processes", processes)
    tell = teller_of(tell)
    if not isinstance(settings, Settings):
        raise wrong("settings", "a record of pyrofit.diagnose.settings.Settings", settings)
    changes = {} if names is None else {"diagnosis.effects": names}
    study = read_study(read_study(study), **changes)
    refuse_programs(study)
    channels = (*calibration_channels(study), *held_out_channels(study))
    keys = [(c.experiment, c.signal) for c in channels]
    series = read_to_fit(study, keys, data)
    _refuse_mixture(study, keys, given_keys(study, data))
    found = examine(study, series, tell, processes, advise, settings=settings)
    return Diagnosis(study, found)


def _refuse_mixture(study: Study, keys: Sequence[Key], given: Sequence[object]) -> None:
    """Refuse computed series that stand beside measured ones."""
    computed = [key for key in keys if study.is_computed(*key)]
    if computed and not given and len(computed) < len(keys):
        name, signal = computed[0]
        raise StudyError(
            f"experiments.{name}.signals.{signal}: computed, but others are measured; a diagnosis "
            "needs measurements of the same sample. Give files, or set diagnosis.hold_out"
        )


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Missing effects of a model; print it for the verdict and the candidates.

    Parameters
    ----------
    study
        The study that was diagnosed.
    found
        The search and the verdict, as the library holds them; they may change with versions.
    """

    study: Study
    found: Found

    @property
    def content(self) -> dict[str, Any]:
        """The keys of ``diagnosis.json``, see docs/diagnosis_json.md."""
        return self._record.model_dump(by_alias=True)

    @property
    def _record(self) -> Record:
        return self.found.content

    @property
    def kind(self) -> str:
        """Kind of the verdict, such as 'none', 'named' or 'ambiguous'."""
        return self._record.verdict.kind

    @property
    def verdict(self) -> str:
        """The verdict in words."""
        return self._record.verdict.words

    @property
    def effects(self) -> list[str]:
        """Names of the effects that the verdict claims."""
        return list(self._record.verdict.effects)

    @property
    def ranking(self) -> pd.DataFrame:
        """The candidates, the best first; of fits with the same effects, the best.

        Columns: effects, chi2, penalised (chi-square with the price of the parameters), gain (of
        the last effect), remark.
        """
        rows = [
            {
                "effects": " + ".join(candidate.effects),
                "chi2": candidate.chi2,
                "penalised": candidate.penalised,
                "gain": candidate.gain,
                "remark": remark_on_candidate(self._record, candidate),
            }
            for candidate in ranked(self._record)
        ]
        return pd.DataFrame(rows, columns=["effects", "chi2", "penalised", "gain", "remark"])

    @property
    def evidence(self) -> pd.DataFrame:
        """Evidence for each effect of the verdict besides the fit, in words and numbers.

        Columns, without those of which there is no test: effect; predictions, changes of the log
        score; agreement, p of equal strengths; correction, the best free one. The column above is
        its -2 ln marginal likelihood relative to the effect.
        """
        return evidence_of(self.study, self._record)

    @property
    def windows(self) -> pd.DataFrame:
        """Intervals of curves that are biased by more than noise explains."""
        return pd.DataFrame(self.content["windows"])

    @property
    def curves(self) -> pd.DataFrame:
        """Measured curves, and simulated ones before and after the effects, SI units."""
        return self.found.curves

    def extended(self) -> Study:
        """Return the study with the effects found, at their fitted strengths.

        Computed measurements become files in its description, which are not there: give them as
        ``data``.

        Raises
        ------
        StudyError
            No effect was found.
        """
        end = self.found.end
        if not end.effects:
            raise StudyError("no effect was found; the study stays as it is")
        computed = {
            (name, signal): {"file": f"{name}_{signal}.csv"}
            for name, experiment in self.study.experiments.items()
            for signal in experiment.signals
            if self.study.is_computed(name, signal)
        }
        keys = extended_keys(self.study, end, computed)
        return as_study(keys, f"study '{self.study.name}'", located=True)

    def report(self) -> str:
        """Return verdict, misfit, certainty and the best candidates as text."""
        tables = (line for _, table in self._tables() for line in ("", text_table(table)))
        return "\n".join([*self._lines(), *tables])

    def _tables(self) -> list[tuple[str, pd.DataFrame]]:
        evidence = [("Evidence", self.evidence)] if len(self.evidence) else []
        return [*evidence, ("Candidates", self.ranking.head(SHOWN))]

    def _lines(self) -> list[str]:
        return [*summary_sentences(self._record), certainty(self.study, self._record)]

    def plot_ranking(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the candidates on ``ax``, by default on a new one."""
        if not self._record.candidates:
            raise StudyError("no effect was fitted: there is nothing to rank")
        ax = plots.wide_axes(len(self.ranking)) if ax is None else plots.axes_of(ax)
        draw_ranking(ax, self._record)
        plots.legend_below_label(ax, ranking_entries(self._record))
        return ax

    def plot(
        self,
        experiment: str | Key | None = None,
        signal: str | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw a signal: measured, fitted by the base model, and with the effects found."""
        pairs = self.curves[["experiment", "signal"]].drop_duplicates()
        keys = [(str(name), str(of)) for name, of in pairs.itertuples(index=False)]
        key = plots.chosen(keys, experiment, signal)
        ax = plots.axes_of(ax)
        here = (self.curves["experiment"] == key[0]) & (self.curves["signal"] == key[1])
        plots.draw_diagnosed(ax, self.study, key, self.curves[here], bool(self.effects))
        return ax

    def __str__(self) -> str:
        """Return the report."""
        return self.report()

    __repr__ = __str__  # a notebook without HTML shows it

    def _repr_html_(self) -> str:
        title = f"Diagnosis of study '{self.study.name}'"
        return html_page(title, self._tables(), self._lines())
