"""Count how often the true reaction scheme of twins is chosen, or one that predicts as well.

python benchmarks/scheme_twins.py OUTPUT.csv --draws 5
"""

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
import pandas as pd
from scheme_truths import SchemeTwin, make_scheme_twin, scheme_named

from pyrofit.scheme.choice import choose_scheme
from pyrofit.scheme.fit import FittedScheme, fit_posed
from pyrofit.scheme.posed import pose_scheme
from pyrofit.scheme.prediction import predict_records
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings

TRUTHS = (
    "single",
    "single_order",
    "single_volatile",
    "single_order_volatile",
    "single_order_volatile_lag",
    "parallel_2",
    "parallel_2_order",
    "parallel_2_volatile",
    "consecutive_2",
    "consecutive_2_order",
    "consecutive_2_volatile",
    "parallel_3",
    "single_catalysis",
    "single_order_catalysis",
    "competing_2",
)
AS_GOOD = 1.1
SMALL = 5e-4
"""Another scheme is equivalent if its error is no larger than 1.1 of the true one's, or by 5e-4."""


def main() -> None:
    """Run the twins and append a row for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path)
    parser.add_argument("--draws", type=int, default=5)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    # Schemes far above the least BIC are never chosen: their predictions are left out here.
    settings = replace(SchemeSettings(), hopeless_bic=100.0)
    rows: list[dict[str, object]] = []
    for draw in range(given.first, given.first + given.draws):
        for k, name in enumerate(TRUTHS):
            scheme = scheme_named(name, settings.most_reactions)
            rows.append(judged(make_scheme_twin(scheme, 1000 * draw + k, settings), scheme))
            print(rows[-1], flush=True)
            pd.DataFrame(rows).to_csv(given.output, index=False)


def judged(twin: SchemeTwin, scheme: Scheme) -> dict[str, object]:
    """Return the scheme chosen for a twin, and the errors of its predictions and the truth's."""
    choice = choose_scheme(twin.setting, lambda text: None)
    chosen = choice.chosen.fitted
    fitted = {c.fitted.name: c.fitted for c in choice.candidates}
    true = fitted.get(scheme.name) or _true(twin, scheme)
    errors = error(twin, chosen), error(twin, true)
    return {
        "truth": scheme.name,
        "chosen": chosen.name,
        "true_parameters": true.posed.count,
        "parameters": chosen.posed.count,
        "error": errors[0],
        "true_error": errors[1],
        "equivalent": errors[0] <= max(AS_GOOD * errors[1], errors[1] + SMALL),
        "size": chosen.size,
    }


def _true(twin: SchemeTwin, scheme: Scheme) -> FittedScheme:
    setting = twin.setting
    posed = pose_scheme(setting.study, scheme, setting.records, setting.settings)
    rng = np.random.default_rng(0)
    return fit_posed(setting, posed, setting.calibrated, [twin.truth], rng, random=0)


def error(twin: SchemeTwin, fitted: FittedScheme) -> float:
    """Return the root mean square of predicted minus true mass at the rates not fitted."""
    others = [r for r in twin.setting.records if not r.calibrated]
    found = predict_records(twin.setting, fitted, others)
    squares = [np.mean((p.curve - twin.clean[p.record.experiment]) ** 2) for p in found]
    return float(np.sqrt(np.mean(squares)))


if __name__ == "__main__":
    main()
