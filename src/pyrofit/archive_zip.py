"""A zip file whose bytes depend only on names and contents."""

import io
import zipfile

Entries = dict[str, bytes]
"""Contents by name in the archive."""
_NO_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest that the format knows


def zipped(entries: Entries) -> bytes:
    """Return a zip file: sorted entries, no dates, no rights of a user."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in sorted(entries):
            about = zipfile.ZipInfo(name, _NO_DATE)
            about.compress_type = zipfile.ZIP_DEFLATED
            about.create_system = 3  # Unix, wherever it is written: the rights mean the same
            about.external_attr = 0o644 << 16
            archive.writestr(about, entries[name])
    return buffer.getvalue()
