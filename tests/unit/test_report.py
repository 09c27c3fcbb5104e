import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from test_tables import described, fake, synthetic

from pyrofit.errors import DataError
from pyrofit.figures import FIGURES
from pyrofit.files import write_text
from pyrofit.report import write_report
from pyrofit.report.truth import sentences
from pyrofit.tables import TABLES

LOADS = {"src", "href", "srcset", "data", "poster", "action"}


class Page(HTMLParser):
    """Collects what a page loads, its anchors, its headings and its words."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.ids: list[str] = []
        self.tags: list[str] = []
        self.words = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            if name in LOADS:
                self.loads.append(value or "")
            if name == "id":
                self.ids.append(value or "")

    def handle_data(self, data: str) -> None:
        self.words += data


def written(root: Path, given: dict[str, Any] | None = None) -> tuple[Page, str]:
    """Write a report with a rectangle for each figure."""
    study, results = fake(root, given)
    for name, figure in FIGURES.items():
        if figure.applies(study):
            write_text(root / "figures" / f"{name}.svg", '<svg width="240.95pt"><rect/></svg>')
    write_report(study, results)
    text = (root / "report.html").read_text()
    return Page(text), text


def test_report_has_all_sections_and_figures(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    sections = ["summary", "data", "kinetics", "fit", "identification", "validation"]
    sections += ["comparison", "provenance"]
    assert [i for i in page.ids if i not in FIGURES] == sections
    assert set(FIGURES) <= set(page.ids)
    assert page.tags.count("figcaption") == len(FIGURES)
    assert len(set(page.ids)) == len(page.ids)


def test_figure_of_half_the_width_is_shown_at_half_the_width(tmp_path: Path) -> None:
    # 170 mm are 481.9 pt.
    _, text = written(tmp_path)
    assert text.count('style="--share: 0.5"') == len(FIGURES)


def test_report_loads_nothing(tmp_path: Path) -> None:
    page, text = written(tmp_path)
    assert page.loads
    assert all(load.startswith(("data:image/svg+xml;base64,", "#")) for load in page.loads)
    assert "http" not in re.sub(r"base64,[A-Za-z0-9+/=]+", "", text)
    assert not {"script", "link", "iframe"} & set(page.tags)
    assert "url(" not in text
    assert "@import" not in text


def test_summary_says_the_numbers(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    for claim in (
        "2 parameters were fitted to Slab 25 kW/m² with 2 cost functions and 3 repetitions each; "
        "slab_60 was held out.",
        "fitted to 1 of 2 heating rates, miss the mass fraction there by 0.0200 (RMSE), "
        "and by 0.0100 at the others; the published set 'book' by 1.01 to 1.02 at all rates.",
        "0.1 for RMSE (published 0.1) and 0.1 for BANDS.",
        "RMSE by 20 %, 1 of 2 starts of least squares agree (k at a limit) and BANDS by 20 %, 1 of "
        "2 starts of least squares agree (k at a limit); SCE-UA stopped at a local optimum for "
        "RMSE; SCE-UA had not converged for BANDS: least squares goes on from there.",
        "at a limit: k (RMSE, BANDS); not determined (spread above 20 % of the limits): cp",
        "predicted with CV(RMSE) 0.250 to 1.25 (fitted data: 0.250 to 1.25); the sets of least "
        "squares predict it with 2.25 to 3.25.",
        "missed by 7.00 to 8.00 K at slab_60 (RMSE).",
        "By the data (width of the 95 % interval, % of the limits): of the kinetics determined "
        "T_p (10.0 %); of the inverse modelling determined k (10.0 %), undetermined cp (70.0 %, "
        "upper bound).",
    ):
        assert claim in page.words
    assert "Slab 25 kW/m²: released 4.000 of " in page.words
    assert "Measured data from 2 files" in " ".join(page.words.split())


def test_synthetic_data_are_said_so(tmp_path: Path) -> None:
    page, _ = written(tmp_path, synthetic())
    assert "Synthetic data." in page.words
    assert "Measured data from" not in page.words
    assert page.words.count("(synthetic data)") == len(FIGURES) - 1 + len(TABLES)


def test_truth_stands_beside_the_estimates_where_it_is_known(tmp_path: Path) -> None:
    page, _ = written(tmp_path, synthetic())
    assert "truth" in page.ids
    # By hand: (0.4985 - 0.2)/0.4 and (1.0 - 1.5)/3; (0.5 - 0.2)/0.4 and 0; (605 - 600)/100.
    for claim in (
        "best sets of SCE-UA are off the truth by: 75 % in k, at most 17 % in the others (RMSE); "
        "75 % in k, at most 17 % in the others (BANDS).",
        "best sets of least squares are off the truth by: 75 % in k, at most 0 % in the others",
        "The kinetics are off by: 5 % in T_p (SCE-UA); 1 % in T_p (least squares).",
    ):
        assert claim in page.words


def test_section_on_the_truth_is_for_synthetic_data_alone(tmp_path: Path) -> None:
    page, _ = written(tmp_path)
    assert "truth" not in page.ids
    assert "synthetic" not in page.words


def test_sentences_on_kinetics_alone_say_nothing_of_costs() -> None:
    errors = {"sceua_error_limits_percent": [2.0], "least_squares_error_limits_percent": [-1.0]}
    table = pd.DataFrame({"fit": "kinetics", "parameter": ["T_p"], **errors})
    assert sentences(table) == [
        "The kinetics are off by: 2 % in T_p (SCE-UA); 1 % in T_p (least squares)."
    ]


def test_study_without_kinetics_and_published_values_has_a_report(tmp_path: Path) -> None:
    given = described(kinetics=None)
    given["imp"]["kinetics"] = "described"
    given["parameters"]["T_p"]["value"] = 600
    del given["published"]
    page, _ = written(tmp_path, given)
    assert "kinetics" not in page.ids
    assert "published" not in page.words


def test_section_on_what_the_data_determine_says_correlation_misfit_and_optimisers(
    tmp_path: Path,
) -> None:
    page, _ = written(tmp_path)
    for claim in (
        "The strongest correlation is that of k and cp, −0.80.",
        "The optimum of the kinetics fits within the noise: chi-square per point is 1.0 (slow,",
        "of the inverse modelling does not fit within the noise: chi-square per point is 3.6 (Slab",
        "kW/m², mass loss rate); the intervals are widened",
        "SCE-UA best 1.00 sd (chi-square 5.00); SCE-UA mean 2.00 sd (chi-square 10.0); least "
        "squares best 3.00 sd (chi-square 15.0); CMA-ES best 4.00 sd (chi-square 20.0).",
    ):
        assert claim in page.words


def test_text_of_the_study_cannot_become_markup(tmp_path: Path) -> None:
    _, text = written(tmp_path, described(title="<script>alert(1)</script>"))
    assert "<script" not in text


def test_provenance_names_what_the_results_rest_on(tmp_path: Path) -> None:
    written(tmp_path)
    first = (tmp_path / "provenance.json").read_bytes()
    origin = json.loads(first)
    assert origin["data"]["slab_60/mlr"] == {"source": "slab.csv", "sha256": "ab12"}
    assert {"config_digest", "seed", "packages", "source_fingerprint"} <= set(origin)
    page, _ = written(tmp_path)
    assert (tmp_path / "provenance.json").read_bytes() == first
    assert origin["config_digest"] in page.words


def test_missing_figure_is_named(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with pytest.raises(DataError, match=r"fig2\.svg: cannot be read"):
        write_report(study, results)
