"""Sections of the report of steps of their own: sensitivity and the worth of tests."""

from pathlib import Path

import pandas as pd
from report_pages import Page, written
from shown_studies import fake

from pyrofit.config import Study
from pyrofit.results.files import Results, write_csv, write_text
from pyrofit.results.step import write_options
from pyrofit.show.report import write_report
from pyrofit.show.table import write_table
from pyrofit.steps.sensitivity import record as sensitivity
from pyrofit.steps.sensitivity.page import TABLES as OF_SENSITIVITY
from pyrofit.steps.worth import record as worth
from pyrofit.steps.worth.page import TABLES as OF_WORTH


def write_sensitivity(study: Study, results: Results) -> None:
    """Write an analysis in which the rate hangs on k first, then on cp, and RMSE sees k alone."""
    inputs = [
        {
            "name": name,
            "label": name,
            "kind": kind,
            "experiment": experiment,
            "unit": "-",
            "low": 0.0,
            "high": 1.0,
            "mean": 0.5,
            "sd": None,
            "source": "limits",
        }
        for name, kind, experiment in (
            ("k", "estimated", ""),
            ("cp", "estimated", ""),
            ("slab_25_flux", "apparatus", "slab_25"),
        )
    ]
    most = {"k": 0.8, "cp": 0.7, "slab_25_flux": 0.1}
    signal = {"experiment": "slab_25", "signal": "mlr", "total": most, "most": most}
    shares = {"k": 0.9, "cp": 0.01, "slab_25_flux": 0.02}
    cost = {
        "words": "a cost",
        "own": True,
        "signals": [["slab_25", "mlr"]],
        "first": shares,
        "total": shares,
    }
    content = {
        "study": study.name,
        "within": "limits",
        "samples": 8,
        "runs": 40,
        "unfinished": 1,
        "inputs": inputs,
        "signals": [{**signal, "most_at_s": {"k": 10.0, "cp": 90.0, "slab_25_flux": 50.0}}],
        "costs": [{**cost, "name": "RMSE", "at_s": None}, {**cost, "name": "NRSE", "at_s": 20.0}],
        "same": [],
        "left_out": ["no GPYRO"],
    }
    sensitivity.write(results, sensitivity.Sensitivity.model_validate(content))
    write_options(study, results, "sensitivity")
    rows = [
        {"time_s": time, "input": name, "total": total, "experiment": "slab_25", "signal": "mlr"}
        for time in (10.0, 50.0, 90.0)
        for name, total in (("k", 0.8 if time < 60.0 else 0.1), ("cp", 0.7), ("slab_25_flux", 0.1))
    ]
    write_csv(results.of_step("sensitivity", sensitivity.OVER_TIME), pd.DataFrame(rows))
    frame = OF_SENSITIVITY["inputs"].make(study, results)
    write_table(
        results.folder("sensitivity"), "table_inputs", OF_SENSITIVITY["inputs"], frame, study
    )
    for name in ("total", "apparatus", "costs"):
        write_text(results.of_step("sensitivity", f"{name}.svg"), "<svg/>")


def write_worth(study: Study, results: Results) -> None:
    """Write two tests: one that leaves a quarter of k, and one that tells nothing."""
    now = {"parameters": {"k": 0.1, "cp": 10.0}, "predictions": {}}
    good = {"parameters": {"k": 0.025, "cp": 9.0}, "predictions": {}}
    rough = {"parameters": {"k": 0.06, "cp": 9.0}, "predictions": {}}
    test = {"quantities": ["mlr"], "gain_bit": 2.0, "left": 0.5}
    content = {
        "study": study.name,
        "points": 100,
        "dispersion": 1.0,
        "apparatus": "exact",
        "draws": 20,
        "estimate": {"k": 0.2, "cp": 2000.0},
        "now": now,
        "now_checked": now,
        "predictions": {},
        "tests": [
            {**test, "name": "a", "words": "a good test", "sds": good, "checked": rough},
            {**test, "name": "b", "words": "an idle test", "sds": now, "checked": None},
        ],
        "left_out": ["a test that fails"],
    }
    worth.write(results, worth.Worth.model_validate(content))
    write_options(study, results, "worth")
    table = OF_WORTH["worth"]
    write_table(results.folder("worth"), "table_worth", table, table.make(study, results), study)
    write_text(results.of_step("worth", "worth.svg"), "<svg/>")


def test_sensitivity_and_worth_are_shown_once_they_are_there(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    assert not {"sensitivity", "worth"} & set(page.ids)
    study, results = fake(tmp_path)
    write_sensitivity(study, results)
    write_worth(study, results)
    write_report(study, results)
    page = Page((tmp_path / "report.html").read_text())
    assert {"sensitivity", "sensitivity_total", "worth", "worth_worth"} <= set(page.ids)
    for words in (
        "40 runs vary 2 estimated parameters over their limits, and 1 other value within",
        "depends most on k from 10 to 50 s",
        "RMSE and NRSE do not see cp (total index below 0.05).",
        "cp shows, though: the mass loss rate of slab_25 has a total index of 0.70 at 90 s.",
        "NRSE looks at 20 s alone and does not see cp",
        "one equation for 2 parameters. 7 % of the variance",
        "Of 1 point of 8 a run did not finish",
        "With the apparatus taken as described, a good test narrows",
        "it leaves 25 % (k) and 90 % (cp).",
        "Their numbers differ most for k with a good test, by 35 percentage points",
        "Nothing is narrowed by 5 % or more by an idle test.",
        "Left out, as its simulation does not finish: a test that fails.",
    ):
        assert words in " ".join(page.words.split()), words
