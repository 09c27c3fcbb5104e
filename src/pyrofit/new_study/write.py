"""Write a study and a folder for a user's own material."""

import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from jinja2 import Environment, PackageLoader, StrictUndefined
from jinja2.loaders import ChoiceLoader

from pyrofit.config.check.study import MOST_LETTERS
from pyrofit.data.spreadsheet import is_spreadsheet
from pyrofit.data.text_file import read_text
from pyrofit.errors import DataError, StudyError
from pyrofit.experiments import OF_FILES, files_of
from pyrofit.experiments.base import Stage
from pyrofit.new_study import draft
from pyrofit.new_study.copied import without_copies
from pyrofit.new_study.divisor import USUAL_AREA_M2
from pyrofit.new_study.draft import KineticsDraft, MeasuredFile
from pyrofit.new_study.facts import facts_of
from pyrofit.new_study.grain import directions_of
from pyrofit.new_study.marks import asked_once
from pyrofit.new_study.pieces import Pieces, said_of_pieces, unequal_masses
from pyrofit.new_study.plan import PartOfPlan, heats, part_of, titles, uncompared
from pyrofit.new_study.repeats import grouped_by_names
from pyrofit.new_study.wide_tables import split_table
from pyrofit.new_study.words import (
    assumes_area,
    has_back,
    held_out,
    lines_on_files,
    number_comment,
    said_of_repeats,
    said_of_scheme,
    signal_lines,
)
from pyrofit.results.files import write_bytes, write_text

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
STAGES: tuple[Stage, Stage] = "kinetics", "imp"
_FILM = 0.05
"""Largest residue that counts as a film, and not as a char."""
_COMBUSTION = "heat_of_combustion_J_kg"
_HEATS = {"heat_of_reaction_J_kg": "dh", "specific_heat_J_kgK": "cp", _COMBUSTION: "dhc"}
"""Parameters of a new study by the key of the material."""
_OF_HEATED = {
    "dh": "dh: {unit: kJ/kg, lower: 100, upper: 3000, label: heat of reaction}",
    "cp": "cp: {unit: kJ/(kg K), lower: 0.8, upper: 3.5, label: specific heat}",
}
"""Lines of parameters that calorimeters show."""
_OF_CHAR = "rho_c", "k_c", "eps_c"
"""Parameters of the char, as slabs show them."""
_RATES = "three heating rates or more"
Files = Mapping[str, Sequence[Path]]
"""Measured files by kind of experiment."""


def init(name: str, files: Files, parent: Path) -> tuple[Path, list[str]]:
    """Write ``<name>/<name>.yaml`` and copies of the files in ``<name>/data``.

    Without any file the measurements are computed, so that the study runs from the start.

    Parameters
    ----------
    name
        Name of study and folder.
    files
        Measured files by kind of experiment.
    parent
        Folder in which the new one is made.

    Returns
    -------
    tuple of Path and list of str
        The study file, and lines for the user: on the recognised and the unknown columns of every
        signal, on unused columns, and on held-out experiments.

    Raises
    ------
    StudyError
        The name is no name, the folder exists, or files are missing for a study.
    DataError
        A file is no table of numbers, or the folder cannot be written.
    """
    folder = parent / name
    _check_name(name)
    if folder.exists():
        raise StudyError(
            f"{folder}: exists already and is left as it is; choose another name, or move it away"
        )
    with TemporaryDirectory() as parts:
        single = {kind: _split(kind, paths, Path(parts)) for kind, paths in files.items()}
        records, copied = without_copies(_records(single))
        tests = grouped_by_names(records) or computed_experiments()
        kinetics = _kinetics(records)
        study = _write(folder, study_text(name, tests, kinetics), records)
    heated, slabs = (part_of(stage, tests) for stage in STAGES)
    lines = [*lines_on_files(records), *copied, *said_of_repeats(tests)]
    lines += [*said_of_pieces(tests), *said_of_scheme(kinetics)]
    lines = [line.replace(parts, f"{folder / 'data'}") for line in lines]
    lines = [*_said_of_tables(files, single), *lines]
    lines += held_out(heated) if heated.held_out else []
    if not slabs.runs:
        return study, [*lines, *([] if heated.held_out else held_out(heated, _RATES))]
    return study, [*lines, *held_out(slabs, beside=heated)]


def _said_of_tables(files: Files, single: Files) -> list[str]:
    """Say which tables hold several tests."""
    given = {path for paths in files.values() for path in paths}
    parts = [path.name for paths in single.values() for path in paths if path not in given]
    if not parts:
        return []
    how = "told by the names of columns or by a number of the test"
    said = f"tables with several tests, {how}, became {', '.join(parts)}"
    return [f"{said}. Times follow from the rates where the table has none"]


def _split(kind: str, paths: Sequence[Path], folder: Path) -> list[Path]:
    """Return the files of single tests, those of tables that hold several in a folder."""
    return [part for path in paths for part in split_table(kind, path, folder)]


def _records(files: Files) -> list[MeasuredFile]:
    records = [draft.read_experiment(kind, path) for kind, paths in files.items() for path in paths]
    draft.check_names_of_files(records)
    return records


def drafted(name: str, files: Files) -> tuple[str, list[MeasuredFile], list[str]]:
    """Return the text of a study for measured files, the records in them, and lines on copies.

    Nothing is written. In the text the files are ``data/<record>.csv``.

    Raises
    ------
    StudyError
        The name is no name, or two files would have one name.
    DataError
        A file is no table of numbers.
    """
    _check_name(name)
    records, copied = without_copies(_records(files))
    return study_text(name, grouped_by_names(records), _kinetics(records)), records, copied


def _write(folder: Path, text: str, records: Sequence[MeasuredFile]) -> Path:
    """Make the folder of a study with copies of the measured files, and return the study file."""
    copies = {record.name: _content(record.path) for record in records if record.path}
    try:
        folder.mkdir(parents=True)
        (folder / "data").mkdir()
    except OSError as error:
        raise DataError(
            f"{folder}: cannot be made ({error.strerror}); choose another folder"
        ) from None
    study = folder / f"{folder.name}.yaml"
    try:
        for record, content in copies.items():
            write_bytes(folder / "data" / f"{record}.csv", content)
        write_text(study, text)
    except KeyboardInterrupt:
        shutil.rmtree(folder)  # half a study would be in the way of the next one
        raise
    return study


def computed_experiments() -> list[MeasuredFile]:
    """Return the experiments whose measurements are computed where there are no files."""
    return [
        MeasuredFile(kind, f"{kind}_{number:g}", None, number)
        for kind in OF_FILES
        for number in files_of(kind).computed
    ]


def study_text(name: str, tests: Sequence[MeasuredFile], kinetics: KineticsDraft) -> str:
    """Return the study file."""
    synthetic = any(test.path is None for test in tests)
    records = [run for test in tests for run in test.repeats or (test,)]
    heated, slabs = (part_of(stage, tests) for stage in STAGES)
    shown = [_HEATS[key] for key in heats(heated.fitted)]
    burns = _COMBUSTION in heats(records)
    of_kinetics = [*_of_scheme(kinetics), *shown]
    estimated = _of_slabs(heated, slabs, shown)
    directions = directions_of(slabs) if kinetics.charring else {}
    of_grain = list(dict.fromkeys(directions.values()))
    estimated += [*_OF_CHAR, *(f"a_{told}" for told in of_grain)] if kinetics.charring else []
    alone = None
    if not slabs.runs:  # kinetics alone: as the first stage of other studies
        heated, slabs = slabs, heated
        estimated = of_kinetics
        alone = [_OF_HEATED[name] for name in shown if name in _OF_HEATED]
    return asked_once(
        _environment()
        .get_template("study.yaml.j2")
        .render(
            name=name,
            synthetic=synthetic,
            kinetics=kinetics,
            virgin=_virgin(alone, estimated),
            residue_density=1000 if kinetics.residue <= _FILM else 250,
            asks_water=alone is None and kinetics.asks_water,
            directions=of_grain,
            experiments=_experiments(
                [*heated.runs, *slabs.runs],
                kinetics.asks_water,
                Pieces(unequal_masses(tests), kinetics.charring),
                directions,
            ),
            kinetics_part=heated,
            kinetics_words=_words(heated),
            kinetics_estimate=of_kinetics,
            burns=burns,
            imp_part=slabs,
            imp_words=_words(slabs),
            imp_estimate=estimated,
            alone=alone,
            left_out=uncompared(slabs),
            tested=held_out(slabs, _RATES) if alone is not None else held_out(slabs, beside=heated),
        )
    )


def _of_scheme(kinetics: KineticsDraft) -> list[str]:
    """Return the parameters of the reactions."""
    if not kinetics.charring:
        return ["T_p", "E_p", *(["y"] if kinetics.tells_residue else [])]
    water = ["w_w", "T_w"] if kinetics.moist else []
    if kinetics.single:
        return ["T_p", "E_p", "y", *water]
    return ["T_e", "E_e", "w_e", "T_m", "E_m", "T_l", "E_l", "n_l", "w_l", "y", *water]


def _virgin(alone: Sequence[str] | None, estimated: Sequence[str]) -> str:
    """Return the properties of the virgin material as a mapping of the study."""
    if alone is None:
        own = "density_kg_m3: rho, conductivity_W_mK: k, specific_heat_J_kgK: cp, emissivity: eps"
        return f"{{{own}}}"
    cp = "cp" if "cp" in estimated else 1500
    return f"{{density_kg_m3: 1000, conductivity_W_mK: 0.2, specific_heat_J_kgK: {cp}}}"


def _kinetics(records: Sequence[MeasuredFile]) -> KineticsDraft:
    """Return where to look for the kinetics, by the records without oxygen where there are some.

    Without any record the measurements are computed, and the limits are those of their material.
    """
    if not records:
        return KineticsDraft(550.0, 680.0, 0.02)
    return draft.kinetics_limits([run for run in records if not run.in_oxygen] or records)


def _environment() -> Environment:
    packages = ("pyrofit.new_study", "pyrofit.experiments")
    return Environment(
        loader=ChoiceLoader([PackageLoader(package, ".") for package in packages]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # YAML, not HTML
    )


def _experiments(
    runs: Sequence[MeasuredFile], moist: bool, pieces: Pieces, directions: Mapping[str, str]
) -> list[str]:
    """Return the lines of each experiment, from the template of its kind.

    ``moist``: slabs hold water beside the material. ``pieces``: their masses, where they differ.
    ``directions``: those of the grain, where they need a factor.
    """
    templates, again, facts = _environment(), titles(runs), facts_of(runs)
    first = _firsts(runs)
    return [
        templates.get_template(f"{run.kind}/new.yaml.j2")
        .render(
            run=run,
            words=run.of.words,
            number=number_comment(run),
            again=again[run.name],
            facts=facts[run.name],
            signals=signal_lines(run, pieces, asks_place=run.name == first.get("back")),
            piece="" if run.repeats else pieces.line(run.name),
            direction=directions.get(run.name),
            moist=moist,
            shared={name: (place == run.name) for name, place in first.items()},
            area=USUAL_AREA_M2 if assumes_area(run) else None,
        )
        .rstrip("\n")
        for run in runs
    ]


def _firsts(runs: Sequence[MeasuredFile]) -> dict[str, str]:
    """Return the first experiment by what experiments share, where a value is asked for once."""
    slabs = [run for run in runs if run.of.stage == "imp"]
    sharing = {
        "slab": slabs,
        "flame": [run for run in slabs if "flame" in run.of.description.model_fields],
        "area": [run for run in slabs if assumes_area(run)],
        "repeats": [run for run in runs if run.repeats],
        "back": [run for run in runs if has_back(run)],
        "baseline": [run for run in runs if "baseline" in run.of.description.model_fields],
    }
    return {name: having[0].name for name, having in sharing.items() if having}


def _of_slabs(heated: PartOfPlan, slabs: PartOfPlan, shown: Sequence[str]) -> list[str]:
    """Return the parameters that slabs are fitted by.

    Heats that heated samples show are taken from these. The specific heat is estimated again: the
    baseline of a calorimeter is easily mistaken for it.
    """
    first = [] if heated.terms else ["T_p", "E_p"]
    burns = [_HEATS[_COMBUSTION]] if _COMBUSTION in heats(slabs.runs) else []
    rest = [name for name in ("dh", *burns) if name not in shown]
    return [*first, "rho", "k", "cp", "eps", *rest]


def _words(part: PartOfPlan) -> str:
    """Return the kinds of experiment of a stage, and their quantities, in words."""
    return " and ".join(dict.fromkeys(run.of.words for run in part.fitted))


def _check_name(name: str) -> None:
    if not _NAME.fullmatch(name):
        raise StudyError(
            f"'{name}' is no name; letters, digits and _ make one, a letter first, as my_wood. "
            "The study is made in the current folder"
        )
    if len(name) > MOST_LETTERS:
        raise StudyError(
            f"'{name[:20]}...' has {len(name)} letters, too many for the name of a folder; use at "
            f"most {MOST_LETTERS}"
        )


def _content(path: Path) -> bytes:
    """Return a file as it is; a spreadsheet as text, for which a study needs no package."""
    try:
        data = path.read_bytes()
        return read_text(path, []).encode() if is_spreadsheet(path, data) else data
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check it") from None
