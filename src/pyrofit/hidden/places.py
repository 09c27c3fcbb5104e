"""Where a plan's results lie."""

from dataclasses import dataclass
from pathlib import Path

FOLDER = Path("results") / "hidden_effects"


@dataclass(frozen=True)
class Places:
    """Paths below one folder: twins as the diagnosis sees them, their truths apart."""

    root: Path

    def twin(self, case: str) -> Path:
        """Folder of a twin: its study and its measurements."""
        return self.root / "twins" / case

    def truth(self, case: str) -> Path:
        """Truth of a twin."""
        return self.root / "truths" / f"{case}.json"

    def case(self, case: str) -> Path:
        """Diagnosis of a twin beside its truth."""
        return self.root / "cases" / f"{case}.json"

    def chunk(self, chunk: int) -> Path:
        """Names of the twins of one job, once all are diagnosed."""
        return self.root / "chunks" / f"{chunk}.json"

    def table(self, name: str) -> Path:
        """Table over all twins."""
        return self.root / "tables" / f"{name}.csv"

    @property
    def page(self) -> Path:
        """All of it on one page."""
        return self.root / "page.md"
