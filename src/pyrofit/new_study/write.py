"""Write a study and a folder for a user's own material."""

import json
import re
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from pyrofit.errors import DataError, StudyError
from pyrofit.new_study import draft
from pyrofit.new_study.columns import Found
from pyrofit.new_study.draft import Kinetics, Measured
from pyrofit.results.files import write_bytes, write_text

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_FILM = 0.05
"""Residue up to which what is left is a film, and not a char."""


def init(
    name: str, tga: Sequence[Path], gasification: Sequence[Path], parent: Path
) -> tuple[Path, list[str]]:
    """Write ``<name>/<name>.yaml`` and copies of the files in ``<name>/data``.

    Without any file the measurements are computed, so that the study runs from the start.

    Parameters
    ----------
    name
        Name of study and folder.
    tga, gasification
        Measured files.
    parent
        Folder in which the new one is made.

    Returns
    -------
    tuple of Path and list of str
        The study file, and a line on every signal: which column is what, and what is not known.

    Raises
    ------
    StudyError
        The name is no name, the folder exists, or files are missing for a study.
    DataError
        A file is no table of numbers, or the folder cannot be written.
    """
    folder = parent / name
    _check(name, folder, tga, gasification)
    records = [draft.tga(path) for path in tga]
    slabs = [draft.gasification(path) for path in gasification]
    draft.check_names([*records, *slabs])
    copies = {record: _content(record.path) for record in (*records, *slabs) if record.path}
    text = study_text(name, records, slabs)
    try:
        folder.mkdir(parents=True)
        (folder / "data").mkdir()
    except OSError as error:
        raise DataError(
            f"{folder}: cannot be made ({error.strerror}); choose another folder"
        ) from None
    for record, content in copies.items():
        write_bytes(folder / "data" / f"{record.name}.csv", content)
    study = folder / f"{name}.yaml"
    write_text(study, text)
    return study, [line for run in (*records, *slabs) for line in _said(run)]


def study_text(name: str, tga: Sequence[Measured], gasification: Sequence[Measured]) -> str:
    """Return the study file; without any experiment, one whose measurements are computed."""
    synthetic = not gasification
    if synthetic:
        tga = [Measured("tga_10K", None, (), (), 10.0, True, {})]
        gasification = [Measured("slab_50", None, (), (), 50.0, True, {})]
    kinetics = Kinetics(550.0, 680.0, 0.02) if synthetic else draft.kinetics_of(tga)
    # What is held out tests the model: the last, where there is more than one.
    rates = [run for run in gasification if run.path is None or run.signals[0].quantity == "mlr"]
    fitted = (rates[:-1] or rates) or list(gasification)
    templates = Environment(
        loader=PackageLoader("pyrofit.new_study", "."),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # YAML, not HTML
    )
    return templates.get_template("study.yaml.j2").render(
        name=name,
        tga=tga,
        gasification=gasification,
        synthetic=synthetic,
        kinetics=kinetics,
        residue_density=1000 if kinetics.residue <= _FILM else 250,
        fitted=fitted,
        backs=[run for run in fitted if len(run.signals) > 1],
        signal=_signal,
        start_temperature=_start_temperature,
    )


def _check(name: str, folder: Path, tga: Sequence[Path], gasification: Sequence[Path]) -> None:
    if not _NAME.fullmatch(name):
        raise StudyError(
            f"'{name}' is no name; letters, digits and _ make one, a letter first, such as my_wood"
        )
    try:
        there = folder.exists()
    except OSError as error:
        raise StudyError(f"'{name}' is no name of a folder ({error.strerror})") from None
    if there:
        raise StudyError(
            f"{folder}: exists already and is left as it is; choose another name, or move it away"
        )
    if tga and not gasification:
        raise StudyError(
            "TGA alone makes no study, the properties are fitted to a mass loss rate; give a file "
            "of one with --gasification, or no file at all for computed measurements"
        )


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check it") from None


def _start_temperature(run: Measured) -> float:
    """Return the temperature [K] at which the back face starts, else that of a room."""
    if "back_temperature" not in run.frames:
        return 293.15
    return round(float(run.frames["back_temperature"]["back_temperature_K"].iloc[0]), 1)


def _signal(run: Measured, found: Found) -> str:
    """Return a signal's lines of the study file."""
    lines = [f"      {found.quantity}:", f"        file: data/{run.name}.csv"]
    if found.missing:
        lines += [
            f"        # CHANGE: no one column is recognised as {' or as '.join(found.missing)}.",
            f"        # The file has: {', '.join(map(_quoted, run.headers))}. Name them, and their",
            "        # units where the file does not: columns: {time: ..., value: ...},",
            "        # units: {time: min, value: ...}; docs/adding.md has an example.",
        ]
    if found.columns:
        lines.append(f"        columns: {_mapping(found.columns)}")
    if found.units:
        guess = " and ".join(found.guessed)
        note = f" # CHANGE where wrong: guessed from the numbers: {guess}" if guess else ""
        lines.append(f"        units: {_mapping(found.units)}{note}")
    if "uncertainty" not in found.columns:
        lines.append("        # uncertainty: ... # in SI units, if you know it: the file has none")
    return "\n".join(lines) + "\n"


def _mapping(words: object) -> str:
    assert isinstance(words, dict)
    return "{" + ", ".join(f"{key}: {_quoted(word)}" for key, word in words.items()) + "}"


def _quoted(word: str) -> str:
    # Text in JSON's quotes is text in YAML, whatever it holds.
    return json.dumps(word, ensure_ascii=False)


def _said(run: Measured) -> list[str]:
    """Say of each signal what was recognised."""
    lines = []
    for found in run.signals:
        parts = []
        for role, header in found.columns.items():
            how = f" in {found.units[role]}" if role in found.units else ""
            how += " (guessed)" if role in found.guessed else ""
            parts.append(f"{role} '{header}'{how}")
        parts += [f"{role} not recognised: name it in the study" for role in found.missing]
        lines.append(f"{run.path}: {found.quantity}: {', '.join(parts)}")
    return lines
