"""A session of the study smoke, and a study of twenty signals."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import pyrofit as pf
from pyrofit.config import Study
from pyrofit_explore.session import Session, session_of

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


@pytest.fixture(scope="package")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    made = session_of(SMOKE, tmp_path_factory.mktemp("results"))
    yield made
    made.close()


@pytest.fixture(scope="package")
def twenty() -> Study:
    keys = pf.read_study(SMOKE).model_dump(mode="json", exclude_defaults=True)
    tests = keys["experiments"]
    for i in range(12):
        tests[f"tga_{i}"] = {**tests["tga_5K"], "heating_rate_K_min": 6 + i}
    tests["slab_40"] = {**tests["slab_25"], "duration_s": 800}
    return pf.read_study(keys)
