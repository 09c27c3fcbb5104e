"""Find or download the measured files of the MaCFP data base, by commit and SHA-256."""

import os
from importlib.resources import files
from pathlib import Path
from urllib.parse import quote

from pyrofit.data.download import FOLDER_VARIABLE, download, sha256
from pyrofit.errors import DataError, suggest

COMMIT = "14b73ea959d3e6a74966a044ba5965aef0a38952"
"""The commit of the GitHub repository MaCFP/matl-db that the registry describes."""

BASE_URL = f"https://raw.githubusercontent.com/MaCFP/matl-db/{COMMIT}/"
"""Where the files of that commit lie."""


def registry() -> dict[str, str]:
    """Give the SHA-256 of every needed file by its path in the data base.

    Returns
    -------
    dict of str to str
        Relative path to 64 hexadecimal digits.

    Examples
    --------
    >>> registry()["LICENSE"][:8]
    'fc5693f6'
    """
    text = files("pyrofit.data").joinpath("registry.txt").read_text(encoding="utf-8")
    pairs = (line.rsplit(maxsplit=1) for line in text.splitlines() if line.strip())
    return {name: digest.removeprefix("sha256:") for name, digest in pairs}


def store() -> Path:
    """Name the folder of the measured files: PYROFIT_DATA_DIR, else the user's cache.

    Returns
    -------
    Path
        An existing folder if PYROFIT_DATA_DIR is set and not empty, else a folder in the cache
        that may not exist yet.

    Raises
    ------
    DataError
        PYROFIT_DATA_DIR is not an existing folder.
    """
    if _has_mirror():
        folder = Path(os.environ[FOLDER_VARIABLE])
        if not folder.is_dir():
            raise DataError(
                f"{FOLDER_VARIABLE}={folder}: this must be an existing folder with the measured "
                "files. Correct the path, or unset the variable and run `pyrofit data fetch`."
            )
        return folder
    import pooch

    return Path(pooch.os_cache("pyrofit")) / f"macfp-{COMMIT[:12]}"


def missing(folder: Path) -> list[str]:
    """List the needed files that a folder lacks; those present are not verified here.

    Parameters
    ----------
    folder : Path
        The folder, which need not exist.

    Returns
    -------
    list of str
        Relative paths, in the order of the registry.

    Examples
    --------
    >>> missing(Path("/no/such/folder"))[0]
    'LICENSE'
    """
    return [name for name in registry() if not (folder / name).is_file()]


def locate(relative: str) -> Path:
    """Give the path of a measured file whose SHA-256 is the registered one.

    Parameters
    ----------
    relative : str
        Path in the data base, such as `PMMA/Calibration_Data/UMD/UMD_TGA_N2_10K.csv`.

    Returns
    -------
    Path
        The verified file.

    Raises
    ------
    DataError
        The name is not in the registry, the file is not in the store, or its checksum is wrong.
    """
    expected = registry()
    if relative not in expected:
        raise DataError(f"unknown measured file '{relative}'. {suggest(relative, expected)}")
    path = store() / relative
    if not path.is_file():
        raise DataError(
            f"{path}: the measured file is not there. Run `make data` (`pyrofit data fetch`) with "
            f"{FOLDER_VARIABLE} unset, or set it to a folder that holds the files."
        )
    if (digest := sha256(path)) != expected[relative]:
        raise DataError(
            f"{path}: SHA-256 is {digest}, but {expected[relative]} is registered: the file was "
            f"altered. Delete it and {_replacement(relative)}."
        )
    return path


def fetch(progress: bool = True, base_url: str = BASE_URL) -> list[Path]:
    """Download the measured files that are not in the store yet, and verify all of them.

    A file appears under its name only after its SHA-256 was found right. If PYROFIT_DATA_DIR is
    set, nothing is downloaded: its files are verified.

    Parameters
    ----------
    progress : bool
        Show a progress bar if the standard error is a terminal.
    base_url : str
        Where the files lie, ending in `/`.

    Returns
    -------
    list of Path
        All files of the registry.

    Raises
    ------
    DataError
        No network, a file is not on the server, a wrong checksum, a full disk, a folder that may
        not be written; or, with PYROFIT_DATA_DIR, a missing or altered file.
    """
    from tqdm import tqdm

    folder = store()
    if _has_mirror():
        return [locate(name) for name in registry()]
    wanted = {
        name: digest
        for name, digest in registry().items()
        if not (folder / name).is_file() or sha256(folder / name) != digest
    }
    # `None` leaves the bar out where the standard error is not a terminal.
    hidden = None if progress and wanted else True
    for name, digest in tqdm(wanted.items(), "measured files", unit="file", disable=hidden):
        download(base_url + quote(name), folder / name, digest)
    return [folder / name for name in registry()]


def _has_mirror() -> bool:
    return bool(os.environ.get(FOLDER_VARIABLE))


def _replacement(relative: str) -> str:
    if _has_mirror():
        return f"put {BASE_URL}{quote(relative)} in its place"
    return "run `pyrofit data fetch`"
