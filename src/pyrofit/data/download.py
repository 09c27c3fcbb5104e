"""One file from an address, whole and of the registered checksum, or not at all."""

import errno
import hashlib
import uuid
from pathlib import Path

from pyrofit.errors import DataError

FOLDER_VARIABLE = "PYROFIT_DATA_DIR"
"""Environment variable: a folder that already holds the files, laid out as upstream."""

_TIMEOUT_S = 30.0


def sha256(path: Path) -> str:
    """Compute the SHA-256 of a file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    str
        64 hexadecimal digits.

    Raises
    ------
    DataError
        The file cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "abc.txt"
    ...     _ = path.write_bytes(b"abc")
    ...     sha256(path)[:8]
    'ba7816bf'
    """
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise DataError(
            f"{path}: the file cannot be read ({error.strerror}); "
            "check its permissions and its disk."
        ) from None


def download(url: str, target: Path, digest: str) -> None:
    """Download beside the target, verify, then rename: the target is whole or absent."""
    part = target.with_name(f".{target.name}.{uuid.uuid4().hex[:12]}.part")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            _transfer(url, part)
            if (given := sha256(part)) != digest:
                raise DataError(
                    f"{url}: SHA-256 is {given}, but {digest} is registered; nothing was kept. "
                    "A proxy or a broken transfer may have altered it: try again, or set "
                    f"{FOLDER_VARIABLE} to a folder that holds the files."
                )
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise DataError(_explain(error, target)) from None


def _transfer(url: str, part: Path) -> None:
    import pooch
    import requests

    try:
        pooch.HTTPDownloader(timeout=_TIMEOUT_S)(url, str(part), None)
    except requests.RequestException as error:
        status = error.response.status_code if error.response is not None else None
        cause = type(error).__name__ if status is None else f"HTTP status {status}"
        raise DataError(
            f"{url}: the download failed ({cause}). Check network and proxy and run "
            f"`pyrofit data fetch` again, or set {FOLDER_VARIABLE} to a folder with the files."
        ) from None


def _explain(error: OSError, target: Path) -> str:
    elsewhere = f"set XDG_CACHE_HOME or {FOLDER_VARIABLE} to another folder"
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"{target}: the disk is full. Free some space, or {elsewhere}."
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return f"{target}: the folder may not be written. Change its permissions, or {elsewhere}."
    return f"{target}: the file cannot be written ({error.strerror}). Repair that, or {elsewhere}."
