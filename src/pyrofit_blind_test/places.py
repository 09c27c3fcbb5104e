"""The paths of a plan's results."""

from dataclasses import dataclass
from pathlib import Path

RESULTS = Path("results")


def folder_of(setting: Path, plan: str) -> Path:
    """Return the folder of a plan's results, below one with the name of the setting's file.

    >>> folder_of(Path("config/blind_test.yaml"), "full").as_posix()
    'results/blind_test/full'
    """
    return RESULTS / setting.stem / plan


@dataclass(frozen=True)
class Places:
    """Paths below one folder; a twin as the diagnosis reads it lies apart from its truth."""

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

    def chunks(self, count: int) -> list[Path]:
        """Files of all jobs."""
        return [self.chunk(chunk) for chunk in range(count)]

    def table(self, name: str) -> Path:
        """Table over all twins."""
        return self.root / "tables" / f"{name}.csv"

    @property
    def page(self) -> Path:
        """The page with all tables and figures."""
        return self.root / "page.md"
