"""How often intervals of slabs hold the truth, with a right model and with wrong ones.

    python benchmarks/slab_intervals.py OUT.csv --twins 80

draws twins of gasification at 25 and 60 kW/m2 as the blind test does (`config/blind_test.yaml`),
with one hidden effect each at full strength, and some with none. The model without effects is
fitted. A row is appended for each parameter whose value the study does not know. The tables count
95 % intervals that hold the truth, and give their median width as a fraction of the search range.
"""

import argparse
import csv
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pandas as pd

import pyrofit as pf
from pyrofit.constants import QUANTILE
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.plan import TwinPlan, cases_of
from pyrofit_blind_test.setting import Setting, read_setting
from pyrofit_blind_test.twin import make_twin, read_twin, write_twin

SETTING = Path("config/blind_test.yaml")
PLAN = {"effects": 2, "nulls": 6, "pairs": 0, "forms": 1, "errors": 0, "left_out": 0, "most": {}}
SIGNALS = "mlr+back"
COLUMNS = (
    "twin",
    "hidden",
    "describes",
    "parameter",
    "truth",
    "value",
    "low",
    "high",
    "holds",
    "holds_with_apparatus",
    "width",
    "verdict",
)


def cases(setting: Setting) -> list[TwinPlan]:
    """Return the twins, in an order that mixes their effects."""
    plan = setting.plans["short"].model_copy(update=PLAN)
    own = setting.model_copy(update={"plans": {"intervals": plan}})
    return [case for case in cases_of(own, "intervals") if case.signals == SIGNALS]


def rows(setting: Setting, case: TwinPlan, folder: Path) -> Iterator[dict[str, object]]:
    """Fit a twin; yield a row for each parameter."""
    places, twin = Places(folder), make_twin(setting, case)
    assert twin.truth.synthetic is not None
    write_twin(places, twin)
    study, data = read_twin(places, case.id)
    fit = pf.fit(study, data)
    for name, truth in twin.truth.synthetic.truth.items():
        if name in study.known or name not in fit.table.index:
            continue
        found = fit.table.loc[name]
        value, low, high = (float(found[key]) for key in ("value", "low", "high"))
        off, end = truth - value, high if truth > value else low
        apart = fit.goodness.describes  # else the interval has the apparatus
        reach = math.hypot(end - value, apart * QUANTILE * float(found["apparatus_sd"]))
        yield {
            "twin": case.id,
            "hidden": " ".join(case.hidden) or "none",
            "describes": fit.goodness.describes,
            "parameter": name,
            "truth": truth,
            "value": value,
            "low": low,
            "high": high,
            "holds": low <= truth <= high,
            "holds_with_apparatus": abs(off) <= reach,
            "width": (high - low) / (float(found["upper"]) - float(found["lower"])),
            "verdict": found["verdict"],
        }


def summary(table: pd.DataFrame) -> str:
    """Return the counts by parameter, as tables in Markdown."""
    lines = []
    for describes, of in table.groupby("describes"):
        kind = "describes the tests" if describes else "misses the tests"
        counts = f"{of['holds'].sum()} ({of['holds_with_apparatus'].sum()}) of {len(of)}"
        lines += [
            f"The model {kind}: {of['twin'].nunique()} twins, {counts} hold (with the apparatus)",
            *(
                f"| {name} | {part['holds'].sum()} of {len(part)} | {part['width'].median():.2f} |"
                for name, part in of.groupby("parameter")
            ),
        ]
    return "\n".join(lines)


def main() -> None:
    """Fit the twins that the table does not have yet."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--twins", type=int, default=80)
    given = parser.parse_args()
    setting = read_setting(SETTING)
    done = set(pd.read_csv(given.out)["twin"]) if given.out.exists() else set()
    for case in cases(setting)[: given.twins]:
        if case.id in done:
            continue
        with tempfile.TemporaryDirectory() as folder:
            found = list(rows(setting, case, Path(folder)))
        with given.out.open("a", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS)
            if file.tell() == 0:
                writer.writeheader()
            writer.writerows(found)
    print(summary(pd.read_csv(given.out)))


if __name__ == "__main__":
    main()
