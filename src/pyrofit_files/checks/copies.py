"""Values that stand in two files."""

from collections.abc import Sequence

from pyrofit.data.copies import copies
from pyrofit_files.examined import Examined


def check_copies(files: Sequence[Examined]) -> None:
    """Look for signals of two tests that are the same from the start on, or up to the end."""
    signals = [(seen, name, signal) for seen in files for name, signal in seen.signals.items()]
    for found in copies([((name, signal.quantity), signal.y) for _, name, signal in signals]):
        seen, _, signal = signals[found.position]
        other = signals[found.of][0].path.name
        if not _said(seen, other):
            seen.say("copy", "fault", f"{found.words} are those of {other}", signal.header)


def _said(seen: Examined, other: str) -> bool:
    return any(f.check == "copy" and f" {other}" in f.text for f in seen.findings)
