from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgb
from shown_studies import described, fake, synthetic

from pyrofit.analysis import running
from pyrofit.analysis.uses import PUBLISHED, predicted_sets, predicted_signals
from pyrofit.config import as_study, read_study
from pyrofit.errors import StudyError
from pyrofit.results.files import Results, read_csv, write_csv
from pyrofit.show import style
from pyrofit.show.curves import tests_of as groups_of
from pyrofit.show.matrix import draw_matrix
from pyrofit.show.sections import FIGURES, make_named, make_subject
from pyrofit.show.subjects.identification.profiles import draw_profiles_of_parameters
from pyrofit.show.subjects.kinetics.drawing import slope
from pyrofit.show.subjects.kinetics.kinetics_all_rates import kinetics_all_rates
from pyrofit.show.subjects.validation.fig3 import fig3

OF_OTHER_STUDIES = {"heats", "unmeasured"}
"""Figures of quantities and experiments that the faked study lacks."""


@pytest.mark.parametrize("title", ["", "Correlation of the estimates (synthetic data)"])
@pytest.mark.parametrize("names", [["a", "b"], ["k_a", "rho_a", "c_a", "eps_a", "dh"]])
def test_matrix_cuts_no_label_off(names: list[str], title: str) -> None:
    matrix = pd.DataFrame(np.eye(len(names)), index=names, columns=names)
    with style.style():
        canvas = draw_matrix(matrix, "correlation [-]")
        canvas.suptitle(title)
        canvas.draw_without_rendering()
        drawn = canvas.get_tightbbox()
    width, height = canvas.get_size_inches()
    assert drawn.x0 >= 0.0
    assert drawn.y0 >= 0.0
    assert drawn.x1 <= width
    assert drawn.y1 <= height


@pytest.mark.parametrize("name", sorted(set(FIGURES) - OF_OTHER_STUDIES))
def test_every_figure_is_written_twice_and_its_svg_alike_each_time(
    name: str, tmp_path: Path
) -> None:
    study, results = fake(tmp_path)
    make_named(name, study, results)
    folder = tmp_path / "figures"
    first = (folder / f"{name}.svg").read_bytes()
    assert (folder / f"{name}.png").stat().st_size > 5000
    make_named(name, study, results)
    assert (folder / f"{name}.svg").read_bytes() == first
    assert b"<dc:date>" not in first
    assert b"synthetic" not in first


@pytest.mark.parametrize("name", FIGURES)
def test_synthetic_data_are_named_in_every_title(name: str, tmp_path: Path) -> None:
    study, results = fake(tmp_path, synthetic())
    if name in {"other_signals", *OF_OTHER_STUDIES}:
        assert not FIGURES[name].applies(study)
        return
    make_named(name, study, results)
    # Text is drawn as paths; the SVG keeps it as comments.
    assert "(synthetic data) -->" in (tmp_path / "figures" / f"{name}.svg").read_text()


@pytest.mark.parametrize("number", [1, 6])
def test_any_number_of_costs_and_experiments_is_drawn(number: int, tmp_path: Path) -> None:
    given = described()
    terms = given["imp"]["costs"]["RMSE"]
    given["imp"]["costs"] = {f"cost_{i}": terms for i in range(number)}
    given["published"]["costs"] = {"cost_0": given["published"]["costs"]["RMSE"]}
    slab = given["experiments"]["slab_60"]
    extra = {f"slab_{i}": slab for i in range(min(number, 4) - 1)}
    given["experiments"] |= extra
    given["validation"] = {"experiments": ["slab_25", *extra]}
    study, results = fake(tmp_path, given)
    for name, figure in FIGURES.items():
        if figure.applies(study):
            make_named(name, study, results)
    drawn = {path.stem for path in (tmp_path / "figures").glob("*.svg")}
    missing = {"fig4", "other_signals"} if number == 1 else set()
    assert drawn == set(FIGURES) - missing - OF_OTHER_STUDIES


def test_figures_of_what_a_study_lacks_do_not_apply() -> None:
    given = described(kinetics=None, validation={"experiments": ["slab_60"]})
    given["imp"]["kinetics"] = "described"
    given["parameters"]["T_p"]["value"] = 600
    study = as_study(given, "fake.json")
    assert {name for name, figure in FIGURES.items() if not figure.applies(study)} == {
        "fig2",
        "kinetics_all_rates",
        "fig3",
        *OF_OTHER_STUDIES,
    }


def test_drawing_leaves_matplotlibs_settings_alone(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    before = dict(mpl.rcParams)
    make_named("fig5", study, results)
    assert dict(mpl.rcParams) == before


def test_unknown_figure_names_the_nearest(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with pytest.raises(StudyError, match="Did you mean 'residuals'"):
        make_named("residual", study, results)


def test_slope_of_a_parabola_is_exact_on_uneven_temperatures_too() -> None:
    temperature = np.linspace(300.0, 400.0, 201)
    grid, rate = slope(temperature, 1.0 - 1e-4 * (temperature - 300.0) ** 2)
    assert np.allclose(rate, 2e-4 * (grid - 300.0), atol=1e-12)
    uneven = np.sort(np.concatenate([temperature, temperature[::3] + 0.1]))
    _, rate = slope(uneven, 2.0 - 0.005 * uneven)
    assert np.allclose(rate, 0.005, atol=1e-12)


@pytest.mark.parametrize("points", [3, 4, 7])
def test_slope_of_few_points_is_taken_over_all_of_them(points: int) -> None:
    temperature = np.linspace(300.0, 400.0, points)
    _, rate = slope(temperature, 2.0 - 0.005 * temperature)
    assert np.allclose(rate, 0.005)


def test_running_minima_by_hand() -> None:
    frame = pd.DataFrame(
        {
            "repetition": [0, 0, 1, 1, 1],
            "generation": [1, 2, 1, 2, 3],
            "calls": [10, 20, 12, 25, 30],
            "best_cost": [5.0, 3.0, 4.0, 2.0, 1.0],
        }
    )
    # From call 12, where both finished a generation; the first keeps 3 after it ended.
    calls, found = running.minima_on_one_axis(frame, "calls")
    assert calls.tolist() == [12, 20, 25, 30]
    assert found.tolist() == [[5, 3, 3, 3], [4, 4, 2, 1]]
    generations, found = running.minima_on_one_axis(frame, "generation")
    assert generations.tolist() == [1, 2, 3]
    assert found.tolist() == [[5, 3, 3], [4, 2, 1]]


def test_running_mean_is_centred_and_leaves_short_records_alone() -> None:
    series = pd.Series(np.arange(100.0) ** 2)
    # 3 % of 100 points are 3: ((n - 1)^2 + n^2 + (n + 1)^2)/3 = n^2 + 2/3.
    assert running.smoothed(series)[50] == pytest.approx(2500.0 + 2.0 / 3.0)
    short = pd.Series([1.0, 5.0, 2.0])
    assert running.smoothed(short).tolist() == [1.0, 5.0, 2.0]


def lightness(colour: str) -> float:
    """Grey of a colour, 0 black to 1 white, as Rec. 601 weighs red, green and blue."""
    return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))


def test_curves_of_three_costs_and_the_band_stay_apart_in_grey() -> None:
    first = [lightness(colour) for colour in style.COLOURS[:3]]
    greys = [lightness(style.MEASURED), *first, lightness(style.BAND), 1.0]
    assert min(np.diff(greys)) > 0.1
    assert len({str(dashes) for dashes in style.DASHES}) == len(style.COLOURS)


def test_published_sets_are_told_apart_from_ours_without_colour(tmp_path: Path) -> None:
    given = described()
    given["published"]["costs"]["BANDS"] = given["published"]["costs"]["RMSE"]
    study, results = fake(tmp_path, given)
    published = [s for s in predicted_sets(study) if s.origin == PUBLISHED]
    with style.style():
        axes = fig3(study, results).axes[0]
    drawn = [line.get_marker() for line in axes.lines if line.get_marker() != "None"]
    assert len(set(drawn)) == len(published) == 2


def with_uncertain_mass(results: Results) -> None:
    """Give one of the TGA runs an uncertainty."""
    path = results.measurement("slow", "mass_fraction")
    write_csv(path, read_csv(path).assign(mass_fraction_uncertainty=0.02))


@pytest.mark.parametrize("name", ["fig2", "kinetics_all_rates"])
def test_uncertainty_of_the_mass_is_a_band_where_it_is_known(name: str, tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    for bands in (0, 1):
        with style.style():
            canvas = FIGURES[name].make(study, results)
        assert sum(len(ax.collections) for ax in canvas.axes) == bands
        entries = [text.get_text() for text in canvas.legends[0].get_texts()]
        assert entries.count("stated uncertainty") == bands
        with_uncertain_mass(results)


@pytest.mark.parametrize("name", ["fig1", "fig2", "fig3", "fig4", "fig5", "kinetics_all_rates"])
def test_axes_of_the_papers_figures_name_quantity_and_unit(name: str, tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with style.style():
        axes = FIGURES[name].make(study, results).axes
    labels = {ax.get_xlabel() for ax in axes} | {ax.get_ylabel() for ax in axes}
    assert {label for label in labels if "[" not in label} <= {"", "generation", "model calls"}
    # Panels without a label share an axis with one that has it.
    for ax in axes:
        below = [other for other in axes if ax in other.get_shared_x_axes().get_siblings(other)]
        assert any(other.get_xlabel() for other in below)


def test_panels_of_several_laboratories_name_them(tmp_path: Path) -> None:
    given = described()
    titles = []
    for laboratories in (("", ""), ("Here", "There")):
        for name, laboratory in zip(("slow", "fast"), laboratories, strict=True):
            given["experiments"][name]["laboratory"] = laboratory
        study, results = fake(tmp_path / f"{len(titles)}", given)
        canvas = kinetics_all_rates(study, results)
        titles.append([ax.get_title(loc="left") for ax in canvas.axes])
    plain, named = titles
    assert not [title for title in plain if "ere, " in title]
    assert [t.split(") ")[1].split(",")[0] for t in named] == ["Here", "There"]


def test_repeats_of_a_test_share_a_panel() -> None:
    study = read_study(Path(__file__).parents[3] / "config" / "pine.yaml")
    groups = groups_of(study, predicted_signals(study, relative=False))
    assert len(groups) == 17
    assert groups[0] == [(f"umd_30_{n}", "mass") for n in (1, 2, 3)]
    assert {len(group) for group in groups} == {2, 3}


def test_many_panels_are_in_more_columns_and_have_two_letters() -> None:
    canvas, axes = style.panels(30, 2, 170.0, 72.0)
    assert axes[2].get_subplotspec().rowspan == axes[0].get_subplotspec().rowspan  # type: ignore[union-attr]
    assert canvas.get_figheight() < 20.0
    style.letter(axes, ["x"] * 30)
    assert [axes[i].get_title(loc="left") for i in (0, 25, 26, 29)] == [
        "a) x",
        "z) x",
        "aa) x",
        "ad) x",
    ]


def test_unknown_subject_names_the_nearest(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    with pytest.raises(StudyError, match="Did you mean 'kinetics'"):
        make_subject("kinetic", study, results)


def test_parameter_at_a_limit_without_a_profile_has_no_empty_panel(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    path = results.identification("estimate.csv")
    table = read_csv(path)
    at_limit = table["parameter"] == "k"
    table.loc[at_limit, "bound"] = "lower"
    profiles_path = results.identification("profiles.csv")
    curves = read_csv(profiles_path)
    write_csv(profiles_path, curves[curves["parameter"] != "k"])
    before = len(draw_profiles_of_parameters(study, results).axes)
    write_csv(path, table)
    assert (
        len([ax for ax in draw_profiles_of_parameters(study, results).axes if ax.axison])
        == before - 1
    )
    table["bound"] = "upper"
    write_csv(path, table)
    write_csv(profiles_path, curves.iloc[:0])
    (ax,) = draw_profiles_of_parameters(study, results).axes
    assert ax.texts[0].get_text() == "all parameters are at limits"


def test_spike_of_a_sensitivity_does_not_hide_the_rest(tmp_path: Path) -> None:
    study, results = fake(tmp_path)
    before = FIGURES["sensitivities"].make(study, results).axes[0]
    path = results.identification("sensitivities.csv")
    table = read_csv(path)
    usual = before.get_ylim()
    assert before.get_xlabel() == "time [s]"
    many = pd.concat([table] * 20, ignore_index=True)
    many.loc[many.index[len(table) // 2], "si"] = 1e4 * table["si"].abs().max()
    write_csv(path, many)
    after = FIGURES["sensitivities"].make(study, results).axes[0]
    assert after.get_ylim()[1] < 10.0 * max(np.abs(usual))
    assert "is cut off" in after.get_xlabel()
