"""Texts of a new study: the lines of a signal, and the columns that were recognised."""

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from pyrofit.experiments import files_of
from pyrofit.experiments.from_files import Told
from pyrofit.new_study.columns import FoundColumn
from pyrofit.new_study.divisor import divisor_of, is_told
from pyrofit.new_study.draft import KineticsDraft, MeasuredFile
from pyrofit.new_study.pieces import Pieces
from pyrofit.new_study.plan import PartOfPlan
from pyrofit.quantities.units import SCALES

_NAMED = 6
"""Files that one line names at most."""
AREA = "sample_area_m2"
_MINUTES = 60.0
_ALIKE = 0.1
"""Share by which two numbers of one test may differ."""


def signal_lines(run: MeasuredFile, pieces: Pieces, asks_place: bool = False) -> list[str]:
    """Return the lines of the study file on the signals of an experiment and on unused columns.

    Each repeat has its piece as well. ``asks_place`` asks once where the thermocouple of the first
    back temperature was.
    """
    lines = []
    for repeat in run.repeats:
        lines.append(f"        {repeat.name}:")
        if piece := pieces.line(repeat.name):
            lines += ["          sample:", f"            {piece}"]
        lines.append("          signals:")
        lines += [f"      {line}" for line in signal_lines(repeat, pieces, asks_place)]
        asks_place = asks_place and not has_back(repeat)
    if run.repeats:
        return lines
    for found in run.signals:
        lines += _signal(run, found)
        if asks_place and found.of.before_backing:
            lines += _place(found)
            asks_place = False
    lines += [f"# Not used: column {_quoted(name)}: {why}." for name, why in run.left.items()]
    return [f"      {line}" for line in lines]


def _signal(run: MeasuredFile, found: FoundColumn) -> list[str]:
    lines = [f"{found.signal}:", f"  file: data/{run.name}.csv"]
    if found.signal != found.quantity:
        lines.append(f"  quantity: {found.quantity}")
    if found.missing:
        lines += [
            f"  # CHANGE: no one column is recognised as {' or as '.join(found.missing)}.",
            f"  # The file has: {', '.join(map(_quoted, run.headers))}. Name them, and their",
            "  # units where the file does not: columns: {time: ..., value: ...},",
            "  # units: {time: min, value: ...}; docs/own_study.md has an example.",
        ]
    if found.columns:
        lines.append(f"  columns: {_mapping(found.columns)}")
    for role, unit in found.unread.items():
        lines += [
            f"  # CHANGE: the file gives the {role} in {_quoted(unit)}, which is not known.",
            f"  # Convert it in the file, or give under `units` one of {_known(found, role)}.",
        ]
    if found.units:
        guess = " and ".join(found.guessed)
        note = f" # CHANGE where wrong: guessed from the numbers: {guess}" if guess else ""
        lines.append(f"  units: {_mapping(found.units)}{note}")
    divisor = divisor_of(found)
    if divisor is not None and (is_told(found, divisor[0]) or divisor[0] != AREA):
        why = (
            "of the file" if is_told(found, divisor[0]) else "CHANGE: the values are divided by it"
        )
        lines.append(f"  {divisor[0]}: {divisor[1]:g} # {why}")
    if found.dried_to is not None:
        lines += [
            f"  relative_to: first value # CHANGE: it starts at {100.0 * found.dried_to:.1f} %, as",
            "  # after a drying; delete this line if the sample lost that mass by pyrolysis",
        ]
    if (begins := _begins(found)) != "":
        lines.append(f"  # CHANGE where wrong: {begins}")
    if (gas := oxygen_words(run)) != "":
        lines.append(f"  # {gas}")
    if run.end is not None:
        lines.append(f"  until_s: {run.end.time_s:g} # {run.end.why}")
    elif run.then_gas:
        lines.append(f"  # CHANGE: {_gas_changes(run)}")
    if found.of.has_sign and (up := found.stated.exothermic_up) is not None:
        lines.append(f"  endothermic: {'negative' if up else 'positive'} # as the file states")
    elif found.of.has_sign:
        lines.append("  endothermic: positive # CHANGE to negative where heat released points up")
    if "uncertainty" not in found.columns:
        lines.append("  # uncertainty: ... # in SI units, if you know it: the file has none")
    return lines


def _begins(found: FoundColumn) -> str:
    """Say that a record starts below the initial mass that its file states."""
    if found.begins_at is None or found.of.scales[0] != "fraction":
        return ""
    return (
        f"it starts at {100.0 * found.begins_at:.1f} % of the stated initial mass, as after a "
        "drying, and is divided by its start; `sample_mass_kg` counts the loss before"
    )


def has_back(run: MeasuredFile) -> bool:
    """Tell whether an experiment has a back temperature."""
    signals = [found for one in run.repeats or (run,) for found in one.signals]
    return any(found.of.before_backing for found in signals)


def _place(found: FoundColumn) -> list[str]:
    """Ask where the sensor of a temperature stood."""
    return [
        "  # CHANGE where a layer such as wool is given as `backing`. Of a thermocouple between",
        f"  # sample and wool, make the quantity {found.of.before_backing}, with layer: 1, in",
        f"  # each such column. This one, {found.quantity}, is that behind all layers.",
    ]


def assumes_area(run: MeasuredFile) -> bool:
    """Tell whether values of an experiment are divided by an area that no file tells."""
    signals = [found for one in run.repeats or (run,) for found in one.signals]
    divisors = [(found, divisor) for found in signals if (divisor := divisor_of(found))]
    return any(key == AREA and not is_told(found, key) for found, (key, _) in divisors)


def lines_on_files(runs: Iterable[MeasuredFile]) -> list[str]:
    """Say how files were read, and what is to be looked at; files of the same share a line."""
    files: dict[str, list[Path]] = {}
    for run in runs:
        for line in _lines_on_file(run):
            files.setdefault(line, []).append(run.path or Path(run.name))
    return [f"{_named(paths)}: {line}" for line, paths in files.items()]


def _named(paths: Sequence[Path]) -> str:
    """Name files: the first with its folder, some more without, and the number of the others."""
    shown = [str(paths[0]), *(path.name for path in paths[1:_NAMED])]
    more = [f"{len(paths) - _NAMED} more"] if len(paths) > _NAMED else []
    return ", ".join([*shown, *more])


def _lines_on_file(run: MeasuredFile) -> list[str]:
    read = [
        f"{found.signal}: {', '.join(_parts(run, found, i))}" for i, found in enumerate(run.signals)
    ]
    read += [f"'{name}' is not used: {why}" for name, why in run.left.items()]
    lines = ["; ".join([*read, *run.mended]), *other_number(run)]
    remarks = ((found.signal, _remark(run, found)) for found in run.signals)
    lines += [f"{signal}: {remark}" for signal, remark in remarks if remark]
    lines += [line for found in run.signals if (line := _begins(found)) != ""]
    if (gas := oxygen_words(run)) != "":
        lines.append(gas)
    if run.end is not None:
        lines.append(f"read until {run.end.time_s:g} s: {run.end.why}")
    elif run.then_gas:
        lines.append(_gas_changes(run))
    return lines


def _parts(run: MeasuredFile, found: FoundColumn, place: int) -> list[str]:
    """Say which columns a signal has; those of the signals before are not told again."""
    before = {(role, header) for one in run.signals[:place] for role, header in one.columns.items()}
    parts = []
    if run.lacks == "time":
        told = "" if run.told in _CERTAIN else ", to be changed in the study"
        parts.append(f"no times: those of a heating rate of {run.number:g} K/min{told}")
    if run.lacks == "temperature":
        parts.append("no temperatures: 300 K + rate t, to be changed in the study")
    for role, header in found.columns.items():
        if (role, header) in before:
            continue
        how = f" in {found.units[role]}" if role in found.units else ""
        how += " (guessed)" if role in found.guessed else ""
        if role in found.unread:
            how = f" in {found.unread[role]}, an unknown unit: convert it, or give another"
        parts.append(f"{role} '{header}'{how}")
    parts += [f"{role} not recognised: name it in the study" for role in found.missing]
    if (divisor := divisor_of(found)) is not None:
        whose = "of the file" if is_told(found, divisor[0]) else "to be changed in the study"
        parts.append(f"divided by {divisor[0]} {divisor[1]:g}, {whose}")
    if found.dried_to is not None:
        parts.append(f"divided by its start, {100.0 * found.dried_to:.1f} %, as after a drying")
    return parts


_CERTAIN = ("record", "file")
_NOT_TOLD: Mapping[Told, str] = {
    "file": "of the file",
    "unit": "CHANGE where wrong: from the name of the file alone",
    "number": "CHANGE: a number in the name of the file, which may mean something else",
    "": "CHANGE: neither the file nor its name tells it",
}


def number_comment(run: MeasuredFile) -> str:
    """Return the comment of the study on a heating rate or flux; empty where none is needed."""
    return _NOT_TOLD.get(run.told, "") or "".join(f"CHANGE: {said}" for said in other_number(run))


def other_number(run: MeasuredFile) -> list[str]:
    """Say that the name of a file hints to another number than its record shows.

    A factor of 60 between both is that of minutes and seconds.
    """
    if run.told not in _CERTAIN or run.hinted is None:
        return []
    if files_of(run.kind).facts(run.frames).get("set_point_K"):
        return []  # a number in the name may be that of the hold
    of, ratio = files_of(run.kind).number, run.number / run.hinted
    times, with_unit = "", of.find(run.path.stem)[1] == "unit" if run.path else False
    if abs(ratio / _MINUTES - 1.0) < _ALIKE:
        times = ", 60 times less: if its times are in minutes, give `units: {time: min}`"
    elif abs(ratio / _MINUTES**2 - 1.0) < _ALIKE:
        times = ", 3600 times less: if its times are in hours, give `units: {time: h}`"
    elif abs(ratio * _MINUTES - 1.0) < _ALIKE:
        times = ", 60 times more: if its times are in seconds, give `units: {time: s}`"
    elif abs(ratio * 1e3 - 1.0) < _ALIKE:
        times = ", 1000 times more: if its times are in ms, divide them by 1000"
    if not times and (abs(ratio - 1.0) < _ALIKE or not with_unit):
        return []
    return [
        f"the record shows a {of.words} of {run.number:g} {of.shown}, its name says "
        f"{run.hinted:g} {of.shown}{times}"
    ]


def oxygen_words(run: MeasuredFile) -> str:
    """Say that the gas around a sample holds oxygen; nothing where it does not."""
    if not run.in_oxygen:
        return ""
    return f"The gas is {run.gas}: the model has no oxidation. Leave the test out, or judge its fit"


def _gas_changes(run: MeasuredFile) -> str:
    return f"the gas is changed to {run.then_gas} in the run; give `until_s`, the time [s] of that"


def assumed(records: Iterable[MeasuredFile]) -> list[str]:
    """Say which numbers, units and columns of records are assumed, and which contradict a name.

    So is that a sample in a gas with oxygen does not oxidise.
    """
    lines, runs = [], list(records)
    for run in runs:
        lines += [f"{run.path}: {said}" for said in other_number(run)]
        lines += [f"{run.path}: {gas}" for gas in [oxygen_words(run)] if gas]
        if run.lacks == "temperature":
            lines.append(f"{run.path}: there is no column of the temperature; a ramp is assumed")
        if run.told not in _CERTAIN:
            of = files_of(run.kind).number
            lines.append(
                f"{run.path}: no {of.words} is given; {run.number:g} {of.shown} is assumed"
            )
        for found in run.signals:
            for role in found.guessed:
                unit = found.units.get(role, "")
                lines.append(f"{run.path}: the unit of the {role} is guessed: {unit}")
    signals = [found for run in runs for found in run.signals]
    heated = all(run.of.stage == "kinetics" for run in runs)
    if signals and heated and not any("mass" in found.of.scales for found in signals):
        lines.append(
            f"no record of a mass is given; a residue of {KineticsDraft.residue:g} kg/kg is "
            "assumed. Heats per kg of gas rest on it: give the mass, or change the residue"
        )
    return lines


def said_of_scheme(kinetics: KineticsDraft) -> list[str]:
    """Say what one reaction leaves out of the records of a solid that hardly chars."""
    if kinetics.charring or not kinetics.known_residue:
        return []
    left = f"the study has one reaction, as the residue is {kinetics.residue:.3g} kg/kg"
    lines = []
    if kinetics.moist:
        lines.append(
            f"{left}; it has no drying, yet {100.0 * kinetics.moisture:.2g} % of the mass is lost "
            "up to 420 K. Begin the fit after it, or add a reaction, as config/pine.yaml has"
        )
    if not kinetics.single:
        lines.append(
            f"{left}; one reaction of first order does not describe these records. "
            "`pyrofit run STUDY scheme` compares schemes"
        )
    return lines


def said_of_repeats(tests: Iterable[MeasuredFile]) -> list[str]:
    """Say which files are taken as repeats of one test."""
    return [
        f"{', '.join(run.name for run in test.repeats)}: taken as repeats of {test.name}; "
        "change that in the study where they are not"
        for test in tests
        if test.repeats
    ]


def _remark(run: MeasuredFile, found: FoundColumn) -> str:
    """Return a remark on suspect values of a record against temperature, or nothing."""
    frame, look = run.frames.get(found.quantity), found.of.remark
    if frame is None or look is None:
        return ""
    return look(frame["temperature_K"].to_numpy(), frame[found.of.column].to_numpy())


def held_out(
    part: PartOfPlan, further: str = "a second radiant flux", beside: PartOfPlan | None = None
) -> list[str]:
    """Say which experiments test the model, or how to get one that does.

    ``beside`` is the stage of the kinetics, where ``part`` is that of slabs.
    """
    if part.held_out:
        use = "them, so they test" if len(part.held_out) > 1 else "it, so it tests"
        return [f"Held out: {', '.join(part.held_out)}. No cost uses {use} the model."]
    nothing = (
        "Nothing is held out: all that is predicted here was fitted, so nothing tests the model."
    )
    if beside is not None and beside.held_out:
        nothing = "No slab is held out: all slabs are fitted, so none tests the model."
    return [
        nothing,
        f"Measure at {further}, add it under `experiments` and name it in `validation`.",
    ]


def _known(found: FoundColumn, role: str) -> str:
    kinds = found.of.scales if role in ("value", "uncertainty") else (role,)
    return ", ".join(unit for kind in kinds for unit in SCALES[kind])


def _mapping(words: Mapping[str, str]) -> str:
    return "{" + ", ".join(f"{key}: {_quoted(word)}" for key, word in words.items()) + "}"


def _quoted(word: str) -> str:
    # Text in JSON's quotes is text in YAML with any content.
    return json.dumps(word, ensure_ascii=False)
