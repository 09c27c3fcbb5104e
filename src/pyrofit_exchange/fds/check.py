"""The proof: the decks in a real FDS, beside pyrofit."""

import json
import math
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.external.fds import NO_FDS
from pyrofit.logs import Tell
from pyrofit.results.files import write_csv, write_text
from pyrofit.solver.outputs import BACK, MASS_FRACTION, RATE
from pyrofit_exchange.fds.agreement import Agreement, heated_agreement, levels, slab_agreement
from pyrofit_exchange.fds.export import WrittenDeck, decks, export, text_of_file
from pyrofit_exchange.fds.read import read_devc, read_tga
from pyrofit_exchange.fds.run import LIMIT_S, run_deck, version_text
from pyrofit_exchange.fds.versions import FdsError, version_of
from pyrofit_exchange.sets import ParameterSet

CHECK, PAGE, CURVES, DECKS = "check.json", "check.md", "curves.csv", "checked"
ENDS_WITHIN_S, ENDS_WITHIN_K = 2.0, 15.0
"""Largest gap at the end of a complete file; a sample lags behind its furnace."""
BURNT = 2e-3

Entry = dict[str, Any]


class Checked(NamedTuple):
    """A deck that was run: its entries of `check.json`, and the curves of both."""

    entries: list[Entry]
    curves: pd.DataFrame | None


def check_decks(
    study: Study,
    chosen: ParameterSet,
    executable: Path | None,
    folder: Path,
    tell: Tell,
    limit_s: float = LIMIT_S,
) -> list[Entry]:
    """Run the decks of a study in FDS; write ``check.json``, ``check.md``, ``curves.csv``.

    Without FDS the files say so, and hold no entries.

    Parameters
    ----------
    study, chosen
        The study and its set.
    executable
        FDS, or none.
    folder
        Where the files go; the decks go to ``checked`` below it.
    tell
        Takes a line on each deck.
    limit_s
        Time limit of a run [s].
    """
    if executable is None:
        tell(NO_FDS)
        _write(folder, [], [f"Not run: {NO_FDS}."])
        return []
    with tempfile.TemporaryDirectory() as temporary:
        text = version_text(executable, Path(temporary))
    version = version_of(text)
    written = decks(study, chosen, version)
    tell(f"FDS {text}: {len(written)} decks, each of 2 to 30 s of computing as a rule")
    checked = [run_one(one, executable, limit_s, tell) for one in written]
    about = {"set": chosen.label, "fds": text}
    entries = [about | entry for one in checked for entry in one.entries]
    curves = [one.curves for one in checked if one.curves is not None]
    if curves:
        write_csv(folder / CURVES, pd.concat(curves, ignore_index=True))
    first = f"FDS {text}, set '{chosen.label}'."
    _write(folder, entries, [first, "", *markdown_of_entries(entries)])
    export(study, chosen, version, folder / DECKS, [f"proof, FDS {text}:", *sentences(entries)])
    return entries


def _write(folder: Path, entries: list[Entry], lines: Iterable[str]) -> None:
    write_text(folder / CHECK, json.dumps(entries, indent=1, allow_nan=False) + "\n")
    write_text(folder / PAGE, "# FDS beside pyrofit\n\n" + "\n".join(lines) + "\n")


def run_one(one: WrittenDeck, executable: Path, limit_s: float, tell: Tell) -> Checked:
    """Run a deck and compare; a run that fails is an entry with its error."""
    name = one.deck.name
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        run = run_deck(executable, text_of_file(one.deck, []), name, folder, limit_s)
        try:
            if run.why:
                raise FdsError(run.why)
            found, agreements = _compared(one, folder)
        except FdsError as error:
            tell(f"{name}: FDS failed: {error}")
            return Checked([_failed(one, str(error), run.seconds)], None)
    entries = [_entry(one, agreement, run.seconds) for agreement in agreements]
    for line in sentences(entries):
        tell(line)
    return Checked(entries, rows_beside(one, found))


def rows_beside(one: WrittenDeck, found: pd.DataFrame) -> pd.DataFrame:
    """Return the curves of FDS and pyrofit, a row for each point of FDS, SI units.

    Columns: ``experiment``, ``signal``, ``time_s`` or ``temperature_K``, ``fds``, ``pyrofit``.
    """
    if not one.deck.step_s:
        pairs = {MASS_FRACTION: (MASS_FRACTION, MASS_FRACTION)}
    else:
        pairs = {RATE: ("rate_kg_m2s", f"{RATE}_kg_m2s"), BACK: ("back_K", f"{BACK}_K")}
    at = "time_s" if one.deck.step_s else "temperature_K"
    parts = []
    for signal, (theirs, ours) in pairs.items():
        x = found[at].to_numpy(float)
        own = np.interp(x, one.curve[at], one.curve[ours])
        columns = {"experiment": one.experiment, "signal": signal, at: x}
        parts.append(pd.DataFrame({**columns, "fds": found[theirs], "pyrofit": own}))
    return pd.concat(parts, ignore_index=True)


def _compared(one: WrittenDeck, folder: Path) -> tuple[pd.DataFrame, list[Agreement]]:
    """Return the curves of FDS and how far they are from pyrofit's.

    Raises
    ------
    FdsError
        A file is missing, or ends before the test does.
    """
    name = one.deck.name
    accepted = levels(one.deck)
    if one.deck.step_s:
        found = read_devc(folder / f"{name}_devc.csv", one.deck.weights)
        last, end = float(found["end_s"].iloc[-1]), float(one.curve["time_s"].iloc[-1])
        if last < end - ENDS_WITHIN_S:
            raise FdsError(f"{name}_devc.csv ends at {last:g} s, the test at {end:.0f} s")
        return found, slab_agreement(found, one.curve, accepted)
    found = read_tga(folder / f"{name}_tga.csv")
    last, end = (float(f["temperature_K"].iloc[-1]) for f in (found, one.curve))
    if last < end - ENDS_WITHIN_K and float(found[MASS_FRACTION].iloc[-1]) > BURNT:
        raise FdsError(f"{name}_tga.csv ends at {last:.0f} K, the programme at {end:.0f} K")
    return found, heated_agreement(found, one.curve, accepted)


def _entry(one: WrittenDeck, agreement: Agreement, seconds: float) -> Entry:
    measure, most = agreement.level
    late = agreement.burnout_s
    return {
        "experiment": one.experiment,
        "signal": agreement.signal,
        "rms_over_mean": agreement.rms_over_mean,
        "burnout_s": late if math.isfinite(late) else None,
        "rms_si": agreement.rms,
        "largest_si": agreement.largest,
        "measure": measure,
        "accepted": most if math.isfinite(most) else None,
        "verdict": agreement.verdict,
        "remarks": [remark.line for remark in one.deck.remarks],
        "seconds": round(seconds, 1),
        "error": "",
    }


def _failed(one: WrittenDeck, why: str, seconds: float) -> Entry:
    empty = dict.fromkeys(
        ("signal", "rms_over_mean", "burnout_s", "rms_si", "largest_si", "measure", "accepted")
    )
    return {
        "experiment": one.experiment,
        **empty,
        "verdict": "failed",
        "remarks": [],
        "seconds": round(seconds, 1),
        "error": why,
    }


def _late(entry: Entry) -> str:
    return "" if entry["burnout_s"] is None else f"{entry['burnout_s']:+.1f}"


def markdown_of_entries(entries: list[Entry]) -> list[str]:
    """Return the entries as lines of a Markdown table."""
    rows = ["experiment | signal | rms over mean, % | burn-out, s | verdict", "---|---|---|---|---"]
    for e in entries:
        share = "" if e["rms_over_mean"] is None else f"{100 * e['rms_over_mean']:.3f}"
        verdict = f"failed: {e['error']}" if e["error"] else e["verdict"]
        rows.append(f"{e['experiment']} | {e['signal'] or ''} | {share} | {_late(e)} | {verdict}")
    return rows


def sentences(entries: list[Entry]) -> list[str]:
    """Return a line for each entry."""
    found = []
    for e in entries:
        if e["error"]:
            found.append(f"  {e['experiment']}: failed, {e['error']}")
            continue
        late = f", burn-out {_late(e)} s" if e["burnout_s"] is not None else ""
        found.append(
            f"  {e['experiment']} {e['signal']}: rms {100 * e['rms_over_mean']:.3f} % of the mean"
            f"{late}: {e['verdict']}"
        )
    return found
