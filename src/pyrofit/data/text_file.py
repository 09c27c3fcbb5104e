"""Read the text of a measured file, in any of the encodings in which instruments write one."""

import stat
from difflib import get_close_matches
from pathlib import Path

from pyrofit.data.spreadsheet import is_spreadsheet, text_of_spreadsheet
from pyrofit.errors import DataError, suggest

LARGEST_BYTES = 500_000_000
"""Size of the largest file that is read."""
_BOMS = {
    b"\xef\xbb\xbf": "utf-8-sig",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
}
_BINARY = {
    b"PK\x03\x04": "a spreadsheet or an archive",
    b"\xd0\xcf\x11\xe0": "a spreadsheet or another binary file",
    b"\x1f\x8b": "a compressed file",
    b"%PDF": "a PDF",
}
_PROGRAMS = {
    ".ngb": "export its data from NETZSCH Proteus as CSV or text, or convert it by `pyngb`",
    ".tri": "export its data from TA TRIOS as CSV or text",
}
"""Ways out by the first letters of an ending."""
_LISTED_FILES = 12
_PROBED_BYTES = 4000


def read_text(path: Path, notes: list[str]) -> str:
    """Return the text of a file, or that of a spreadsheet; note an encoding that is not UTF-8.

    A byte-order mark tells the encoding. Without one it is UTF-16 where every other byte is zero,
    else UTF-8, else Windows-1252, which holds Latin-1.

    Raises
    ------
    DataError
        The file is absent, a folder, a pipe or a device, too large, unreadable or no text.
    """
    try:
        mode, size = path.stat().st_mode, path.stat().st_size
        if stat.S_ISDIR(mode):
            raise DataError(f"{path}: this is a folder; give a file in it.")
        if not stat.S_ISREG(mode):
            raise DataError(
                f"{path}: this is a pipe, a socket or a device; give a file on a disk. "
                "Save its content in one first."
            )
        _check_size(path, size)
        data = path.read_bytes()
    except FileNotFoundError:
        raise DataError(f"{path}: there is no such file. {_near_files(path)}") from None
    except OSError as error:
        raise DataError(
            f"{path}: the file cannot be read ({error.strerror}); "
            "check its permissions and its disk."
        ) from None
    except ValueError:
        raise DataError(f"{str(path)!r}: this is no name of a file; correct it.") from None
    if is_spreadsheet(path, data):
        return text_of_spreadsheet(path, data, notes)
    return _decoded(path, data, notes)


def _check_size(path: Path, size: int) -> None:
    if size > LARGEST_BYTES:
        raise DataError(
            f"{path}: {size / 1e6:,.0f} MB; files of at most {LARGEST_BYTES / 1e6:,.0f} MB are "
            "read. Keep every n-th row, or the columns that are needed."
        )


def _decoded(path: Path, data: bytes, notes: list[str]) -> str:
    what = next((words for start, words in _BINARY.items() if data.startswith(start)), None)
    if what is not None:
        raise DataError(f"{path}: this is {what}, no text; {_way_out(path)}.")
    encoding = next((name for bom, name in _BOMS.items() if data.startswith(bom)), None)
    encoding = encoding or _utf16(data) or "utf-8"
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        notes.append(f"not UTF-8 (line {line}): read as cp1252")
        text, encoding = data.decode("cp1252", errors="replace"), "cp1252"
    if encoding.startswith("utf-16"):
        notes.append("read as UTF-16")
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise DataError(
            f"{path}, line {line}: a byte 0 stands here, so this is no text; {_way_out(path)}."
        )
    return text


def _way_out(path: Path) -> str:
    ending = path.suffix.casefold()
    own = (words for start, words in _PROGRAMS.items() if ending.startswith(start))
    return next(own, "save or export the table as CSV or text")


def _utf16(data: bytes) -> str:
    """Return the kind of UTF-16 that bytes without a byte-order mark look like; else nothing."""
    first = data[:_PROBED_BYTES]
    half = len(first) // 2
    for start, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if half and first[start::2].count(0) > 0.6 * half and not first[1 - start :: 2].count(0):
            return name
    return ""


def _near_files(path: Path) -> str:
    if not path.parent.is_dir():
        return f"Its folder {path.parent} does not exist either; check the path."
    names = sorted(entry.name for entry in path.parent.iterdir() if entry.is_file())
    if not names:
        return f"Its folder {path.parent} holds no files; check the path."
    if len(names) > _LISTED_FILES:
        names = get_close_matches(path.name, names, _LISTED_FILES, 0.0)
    return suggest(path.name, names)
