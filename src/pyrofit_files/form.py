"""The form of a contribution of measured files to a data base, in Markdown."""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from pyrofit.errors import DataError
from pyrofit_files.examined import Examined, FileFinding

_HEATED = ("tga", "dsc", "mcc")


def form_of(files: Sequence[Examined], folder: Path) -> str:
    """Return the form: the files, the checks, and the findings to explain.

    Ticks are set by the examination; boxes without a tick are for the contributor.

    Parameters
    ----------
    files
        The examined files.
    folder
        Their folder.
    """
    laboratories = sorted({seen.label.laboratory for seen in files if seen.label.kind})
    kinds = Counter(seen.kind or "unknown" for seen in files)
    counts = ", ".join(f"{number} {kind}" for kind, number in kinds.most_common())
    lines = [
        f"# Measured files of {', '.join(laboratories) or folder.resolve().name}",
        "",
        f"{len(files)} files: {counts}.",
        "",
        "## Checked",
        "",
        *_checklist(files),
        "",
        "## By the contributor",
        "",
        "- [ ] Each fault below is corrected.",
        "- [ ] Each doubt below is corrected, or explained in its last column.",
        "- [ ] The README tells material, apparatus, calibration, gas and its flow.",
        "- [ ] The data may be published under the licence of the data base.",
        "",
        "## Files",
        "",
        "| file | kind | conditions | signals |",
        "|---|---|---|---|",
        *(
            _row(_name(seen, folder), seen.kind, seen.label.conditions, seen.signals_in_words)
            for seen in files
        ),
    ]
    for weight, last in (("fault", ""), ("doubt", "explanation")):
        lines += _findings(files, folder, weight, last)
    return "\n".join(lines) + "\n"


def check_form(files: Sequence[Examined], form: Path) -> None:
    """Refuse files with faults, or of unknown kind.

    Raises
    ------
    DataError
        With their numbers and the place of the form.
    """
    faults = len(list(_of_weight(files, "fault")))
    unknown = sum(not seen.classified for seen in files)
    if faults or unknown:
        raise DataError(
            f"{form}: {faults} faults, {unknown} files that are not classified; a contribution has "
            "none. Correct the files that it lists and run the command again."
        )


def _checklist(files: Sequence[Examined]) -> Iterator[str]:
    """Yield a line for each thing that was checked, with a tick where it holds for all files."""
    unnamed = [seen for seen in files if not seen.label.kind or not seen.label.repeat]
    bare = [seen for seen in files if seen.kind not in _HEATED and seen.facts.thickness_m is None]
    massless = [seen for seen in files if seen.facts.mass_kg is None]
    for words, failing in (
        ("Each file is a table of a known kind.", [s for s in files if not s.classified]),
        ("No file has a fault.", [s for s in files if _has(s, "fault")]),
        ("No file has a doubt.", [s for s in files if _has(s, "doubt")]),
        ("Each name is `LAB_KIND_..._R1`.", unnamed),
        ("The README gives the initial mass of each test.", massless),
        ("The README gives the thickness of each slab.", bare),
    ):
        rest = f" Not so: {len(failing)}, the first is {failing[0].path.name}." if failing else ""
        yield f"- [{' ' if failing else 'x'}] {words}{rest}"


def _findings(files: Sequence[Examined], folder: Path, weight: str, last: str) -> Iterator[str]:
    """Yield the table of all findings of a weight; nothing where there are none."""
    found = list(_of_weight(files, weight))
    if not found:
        return
    yield from ("", f"## {weight.capitalize()}s", "")
    names = ["file", "column", "check", "finding", *([last] if last else [])]
    yield _row(*names)
    yield "|" + "---|" * len(names)
    for seen, finding in found:
        cells = (_name(seen, folder), finding.column, finding.check, finding.text)
        yield _row(*cells, *([""] if last else []))


def _of_weight(files: Sequence[Examined], weight: str) -> Iterator[tuple[Examined, FileFinding]]:
    return ((seen, f) for seen in files for f in seen.findings if f.weight == weight)


def _has(seen: Examined, weight: str) -> bool:
    return any(finding.weight == weight for finding in seen.findings)


def _name(seen: Examined, folder: Path) -> str:
    return f"`{seen.path.relative_to(folder).as_posix()}`"


def _row(*cells: str) -> str:
    r"""Return the row of a table; a bar or a line break in a cell would end it.

    >>> _row("a|b", "")
    '| a\\|b |  |'
    """
    return "| " + " | ".join(" ".join(c.replace("|", "\\|").split()) for c in cells) + " |"
