"""A session of the study smoke."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from pyrofit.explore.session import Session, session_of

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


@pytest.fixture(scope="package")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    made = session_of(SMOKE, tmp_path_factory.mktemp("results"))
    yield made
    made.close()
