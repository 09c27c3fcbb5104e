"""One file with all of a study: its inputs, its results, and the files to run it again.

Measured files of the MaCFP data base are not copied: their commit and checksums stand in the
provenance. Equal results give equal bytes: entries are sorted and carry no date.
"""

import csv
import hashlib
import io
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pyrofit import __version__
from pyrofit.archive_crate import METADATA, metadata
from pyrofit.archive_software import LOCK, VERSIONS, is_project, software
from pyrofit.archive_texts import AGAIN, AGAIN_LOCKED, COMMENT, MACFP_FILES, README
from pyrofit.archive_zip import Entries, zipped
from pyrofit.config import Study, as_yaml, digest
from pyrofit.config.expand.programs import program_files
from pyrofit.errors import DataError
from pyrofit.model.signal import Signal
from pyrofit.plugins import folder_names, plugin_files
from pyrofit.provenance import STUDY, source_fingerprint
from pyrofit.results.code_digests import code
from pyrofit.results.files import Results, read_json, write_bytes
from pyrofit.results.step import Inputs, inputs_of
from pyrofit.show.sections import FIGURES, TABLES
from pyrofit.stages.reading import MACFP
from pyrofit.steps import known_steps

_PAGES = ("study.json", "provenance.json", "report.html")
_LEFT_OUT = ("by_hand", "inputs", "logs", "benchmarks", "running", "unfinished")
"""Folders of results that differ from run to run."""


def write_archive(study: Study, results: Results, given: Sequence[Path], project: Path) -> Path:
    """Write ``<name>.zip`` beside the results of a study; return its path.

    Parameters
    ----------
    study
        The study as it was run.
    results
        Its results, complete.
    given
        The study files as the user wrote them.
    project
        The folder with Snakefile and requirements.lock, or any other one: see `software`.

    Raises
    ------
    DataError
        A result or file is missing, or the results are those of another study or source.
    """
    origin = read_json(results.root / "provenance.json", {("data",): dict})
    _check_origin(study, results, origin)
    own = _places("data", study.own_files)
    _check_files(own, origin["data"])
    # Programs find them by name: one of two files of the same name goes into another folder.
    of_programs = _places("programs", program_files(study), "/")
    entries: Entries = {"study.yaml": _study_file(study, own | of_programs).encode()}
    as_given = _places("as_given", [str(path) for path in given])
    entries |= {inside: _bytes(Path(file)) for file, inside in as_given.items()}
    entries |= {inside: _bytes(Path(file)) for file, inside in own.items()}
    entries |= {inside: _bytes(Path(file)) for file, inside in of_programs.items()}
    for inside, path in plugin_files([Path(folder) for folder in study.plugins]).items():
        entries[f"plugins/{inside}"] = _bytes(path)
    for path in result_files(study, results):
        name = path.relative_to(results.root).as_posix()
        entries[f"results/{name}"] = _without_macfp(study, path)
    entries |= {f"software/{name}": content for name, content in software(project).items()}
    entries["README.txt"] = _readme(study, origin, is_project(project)).encode()
    entries[METADATA] = metadata(study, origin, entries)
    sums = [f"{hashlib.sha256(entries[n]).hexdigest()}  {n}\n" for n in sorted(entries)]
    entries["SHA256SUMS"] = "".join(sums).encode()
    target = results.root / f"{study.name}.zip"
    write_bytes(target, zipped(entries))
    return target


def _check_origin(study: Study, results: Results, origin: Mapping[str, Any]) -> None:
    """Refuse results of another study, and of a source that is not the one to be packed."""
    for key, now, what in (
        ("config_digest", digest(study.model_dump(mode="json")), "the study has"),
        ("source_fingerprint", source_fingerprint(*STUDY), "pyrofit or its packages have"),
        ("code", code(study), "an effect, a quantity or a cost has"),
    ):
        if origin.get(key) != now:
            raise DataError(
                f"{results.root}: {what} changed since these results were made; run the workflow "
                "again, then archive"
            )


def _check_files(own: Container[str], read: Mapping[str, Any]) -> None:
    """Refuse measured files that changed after the results were made."""
    for entry in read.values():
        file = entry["source"]
        if file in own and hashlib.sha256(_bytes(Path(file))).hexdigest() != entry["sha256"]:
            raise DataError(f"{file}: changed since it was read; run the workflow again")


def _readme(study: Study, origin: Mapping[str, Any], locked: bool) -> str:
    text = README.format(
        title=study.title or study.name,
        name=study.name,
        version=__version__,
        fingerprint=origin["source_fingerprint"],
        versions=LOCK if locked else VERSIONS,
        again=AGAIN_LOCKED if locked else AGAIN,
    )
    if study.needs_macfp:
        text += MACFP_FILES.format(count=len(set(study.needs_macfp)), commit=origin["macfp_commit"])
    return text


def _places(folder: str, files: Sequence[str], between: str = "_") -> dict[str, str]:
    """Return a place of its own in the archive for each of the user's files.

    ``between`` joins a number and a name that is taken.
    """
    places: dict[str, str] = {}
    for file in files:
        name = f"{folder}/{Path(file).name}"
        if name in places.values():
            name = f"{folder}/{len(places)}{between}{Path(file).name}"
        places[file] = name
    return places


def _study_file(study: Study, own: Mapping[str, str]) -> str:
    """Return the study as YAML, its own files where the archive has them."""
    keys = study.model_dump(mode="json", exclude_defaults=True)
    for experiment in keys["experiments"].values():
        for signal in experiment["signals"].values():
            signal["file"] = own.get(signal["file"], signal["file"])
        if program := experiment.get("program"):
            program["template"] = own[program["template"]]
            program["files"] = [own[file] for file in program.get("files", ())]
    if study.plugins:
        folders = [Path(folder) for folder in study.plugins]
        keys["plugins"] = [f"plugins/{name}" for name in folder_names(folders)]
    return as_yaml(keys, COMMENT)


def result_files(study: Study, results: Results) -> Iterator[Path]:
    """Yield the files of results that go into the archive."""
    measured = {
        results.measurement(name, quantity)
        for name, quantity, signal in _signals(study)
        if signal.file.startswith(MACFP)
    }
    steps = {name: inputs_of(name) for name in known_steps()}
    # Pages leave out parts that are not up to date, as they are repeated on request only.
    stale = {n for n, step in steps.items() if step.version and not step.version(study, results)}
    for path in results.root.rglob("*"):
        parts = path.relative_to(results.root).parts
        if parts[0] in stale:
            continue
        if path.is_file() and path not in measured and _belongs(study, *parts):
            yield path


def _belongs(study: Study, folder: str, *inside: str) -> bool:
    """Tell whether a result is this study's, not left of an earlier one nor of a single run."""
    if not inside:
        return folder in _PAGES
    name, stem = inside[-1], Path(inside[-1]).stem
    if folder in _LEFT_OUT or name.startswith("."):
        return False
    if folder == "programs":
        return inside == ("trial.json",) or (inside[1:2] == ("failed",) and len(inside) == 3)
    if folder == "tables":
        return stem in TABLES and TABLES[stem].applies(study)
    if folder == "figures":
        return stem in FIGURES and FIGURES[stem].applies(study)
    if folder in known_steps():
        return _of_step(study, inputs_of(folder), name)
    if folder == "imp" and len(inside) > 1:
        number = re.match(r"\d+", name)
        current = number is None or int(number[0]) < study.imp.repetitions
        return current and inside[0] in study.imp.costs
    return True


def _of_step(study: Study, step: Inputs, name: str) -> bool:
    """Tell whether a file of a step is none of a part that the study does not have."""
    prefix, _, suffix = step.part_file.partition("{part}")
    if name in step.files or not prefix + suffix:
        return True
    known = {f"{prefix}{part}{suffix}" for part in step.parts(study)}
    return name in known or not (name.startswith(prefix) and name.endswith(suffix))


def _signals(study: Study) -> Iterator[tuple[str, str, Signal]]:
    for name, experiment in study.experiments.items():
        signals: Mapping[str, Signal] = experiment.signals
        for quantity, signal in signals.items():
            yield name, quantity, signal


def _without_macfp(study: Study, path: Path) -> bytes:
    """Return a result; its copies of values from files of the data base are left empty."""
    content = _bytes(path)
    if path.suffix != ".csv" or not study.needs_macfp:
        return content
    rows = list(csv.reader(io.StringIO(content.decode())))
    if not {"experiment", "signal", "measured"} <= {*rows[0]}:
        return content
    at, of, measured = (rows[0].index(key) for key in ("experiment", "signal", "measured"))
    theirs = {(n, q) for n, q, signal in _signals(study) if signal.file.startswith(MACFP)}
    for row in rows[1:]:
        if (row[at], row[of]) in theirs:
            row[measured] = ""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise DataError(
            f"{path}: cannot be read ({error.strerror}); the archive needs it"
        ) from None
