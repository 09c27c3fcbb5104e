"""The step that the documentation describes is found by command, study, pages and workflow."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from bad_input import FILES

ROOT = Path(__file__).parents[2]
SECTION = (ROOT / "docs" / "adding.md").read_text(encoding="utf-8").split("\n## A step\n")[1]
EXAMPLE = re.findall(r"`(\w+\.py)`[^`]*?(?:`[^`\n]*`[^`]*?)*```python\n(.*?)```", SECTION, re.S)
"""Name and text of each file of the example."""
RUN = """
import json, sys
from pathlib import Path
import pyrofit.steps
pyrofit.steps.__path__.append(sys.argv[1])
from pyrofit.cli import main
from pyrofit.config import digest, read_study
from pyrofit.config.keys.steps import with_options
from pyrofit.results.step import inputs_of, slice_of
from pyrofit.running.targets import targets
codes = [main(["peaks", "study.yaml", *more]) for more in ([], ["--share", "0.8"])]
main(["reference"])
study = read_study(Path("study.yaml"))
other = study.model_copy(update={"steps": with_options(study.steps, "peaks", {"share": 0.8})})
print("TOLD", json.dumps({
    "codes": codes,
    "target": targets().get("peaks"),
    "differ": digest(slice_of(study, "peaks")) != digest(slice_of(other, "peaks")),
    "files": inputs_of("peaks").files,
}))
"""


class Done(NamedTuple):
    """What the documented step leaves behind and prints."""

    folder: Path
    said: str
    told: dict[str, Any]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Done:
    folder = tmp_path_factory.mktemp("new_step")
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "steps" / "peaks").mkdir(parents=True)
    for name, text in EXAMPLE:
        (folder / "steps" / "peaks" / name).write_text(text, encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-c", RUN, str(folder / "steps")],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    said, _, told = run.stdout.partition("TOLD ")
    return Done(folder, said, json.loads(told))


def near(done: Done, place: str) -> dict[str, float]:
    """Return the written time near the peak by signal."""
    content = json.loads((done.folder / "results/small" / place / "peaks.json").read_text())
    return {f"{of['experiment']} {of['signal']}": of["near_s"] for of in content["signals"]}


def test_documented_step_has_the_files_of_its_table() -> None:
    table = re.findall(r"^\| `(\w+\.py)` \|", SECTION, re.M)
    assert sorted(name for name, _ in EXAMPLE) == sorted(table)
    assert 4 <= len(EXAMPLE) <= 6


def test_documented_step_computes_and_prints_its_sentences(done: Done) -> None:
    assert done.told["codes"] == [0, 0]
    assert "Of 4 signals, slab_25 back_temperature peaks last." in done.said
    # 0.01 exp(-((t - 150)/60)^2) is above half of its largest value from 105 to 195 s.
    assert near(done, "peaks")["slab_25 mlr"] == 90.0


def test_other_options_of_the_documented_step_stand_apart(done: Done) -> None:
    assert near(done, "by_hand/peaks")["slab_25 mlr"] == 50.0


def test_documented_step_leaves_the_files_that_the_workflow_waits_for(done: Done) -> None:
    assert all(
        (done.folder / "results/small/peaks" / name).is_file() for name in done.told["files"]
    )


def test_documented_step_is_a_target_with_options_in_fingerprint_and_reference(done: Done) -> None:
    assert done.told["target"] == "List the largest value of each measured signal."
    assert done.told["differ"]
    assert "- `share`: a signal is near its peak above this share of it" in done.said
