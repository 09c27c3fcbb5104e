"""Data against limits: sets, band, windows outside, causes, words, figures."""

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from pyrofit.cli import main
from pyrofit.config import Study, as_study, read_study
from pyrofit.effects.base import changed
from pyrofit.experiments import kind_of
from pyrofit.experiments.dsc import Dsc
from pyrofit.model.slab import Backing, SlabExperiment
from pyrofit.results.files import Results, write_csv
from pyrofit.stages.measurements import computed
from pyrofit.steps.preview import reach
from pyrofit.steps.preview.compute import OF_REPEATS, all_simulated, preview, windows
from pyrofit.steps.preview.corrections import possible_corrections
from pyrofit.steps.preview.figures import draw_experiments
from pyrofit.steps.preview.fit import nearest
from pyrofit.steps.preview.inputs import INPUTS
from pyrofit.steps.preview.likely_cause import WEIGHT, LikelyCause
from pyrofit.steps.preview.page import PAGE
from pyrofit.steps.preview.reach import (
    NOISE,
    OF_BAND,
    OF_RANGE,
    RecordedCases,
    case_of,
    peak_off,
    reached,
    simulate_all,
)
from pyrofit.steps.preview.record import BANDS, Likely, NearestSet, Preview, Window, write
from pyrofit.steps.preview.sentences import sentences_on
from pyrofit.steps.preview.sets import draw_sets

CONFIG = Path(__file__).parents[3] / "config"
SMOKE = CONFIG / "smoke.yaml"
Frames = dict[tuple[str, str], pd.DataFrame]


@cache
def smoke() -> tuple[Study, Frames]:
    study = read_study(SMOKE)
    return study, computed(study, fast=True)


# --- sets -----------------------------------------------------------------------------------


def test_sets_fill_the_limits_evenly_and_are_those_of_the_seed() -> None:
    study, _ = smoke()
    sets = draw_sets(study, study.parameters, 300)
    assert sets.names == tuple(study.parameters)
    counts = [np.histogram(column, bins=10, range=(0.0, 1.0))[0] for column in sets.unit.T]
    assert np.min(counts) >= 28
    assert np.max(counts) <= 32
    rho = np.asarray(sets.values["rho"])
    assert 900.0 <= rho.min() < 905.0
    assert 1495.0 < rho.max() <= 1500.0
    assert np.array_equal(sets.unit, draw_sets(study, study.parameters, 300).unit)
    other = study.model_copy(update={"seed": study.seed + 1})
    assert not np.array_equal(sets.unit, draw_sets(other, study.parameters, 300).unit)


def test_sets_stay_near_known_values() -> None:
    given = smoke()[0].model_dump(mode="json", exclude_defaults=True)
    study = as_study({**given, "known": {"rho": {"value": 1200.0, "sd": 10.0}}}, "smoke.json")
    rho = np.asarray(draw_sets(study, study.parameters, 100).values["rho"])
    assert 1170.0 <= rho.min() < rho.max() <= 1230.0


def test_sets_at_ends_hold_all_other_parameters() -> None:
    study, _ = smoke()
    sets = draw_sets(study, study.parameters, 4)
    ends = sets.at_ends("k")
    assert np.asarray(ends.values["k"]).tolist() == [0.1] * 4 + [0.4] * 4
    assert np.array_equal(np.asarray(ends.values["cp"])[:4], np.asarray(ends.values["cp"])[4:])


# --- band -----------------------------------------------------------------------------------


def test_distance_beside_the_band_counts_from_the_margin() -> None:
    curves = np.array([[0.0, 1.0, 2.0], [0.0, 2.0, 4.0]])
    found = reached(np.array([0.0, 5.0, -3.0]), curves, np.zeros(3))
    assert found.scale == 8.0  # of the record; the curves have 2 and 4
    assert found.share_outside == 1.0  # the point inside is zero
    margin = OF_RANGE * 8.0 + OF_BAND * np.array([0.0, 1.0, 2.0])
    assert found.beyond == pytest.approx([0.0, 5.0 - 2.0 - margin[1], -(2.0 + 3.0 - margin[2])])
    assert found.outside == pytest.approx(np.abs(found.beyond).mean() / 8.0)


def test_noise_widens_the_margin_by_three_standard_deviations() -> None:
    curves = np.array([[0.0, 1.0], [0.0, 1.0]])
    assert reached(np.array([0.0, 1.5]), curves, np.full(2, 0.01)).beyond[1] > 0.0
    assert reached(np.array([0.0, 1.5]), curves, np.full(2, 0.17)).beyond[1] == 0.0


def test_sets_that_do_not_finish_make_no_band() -> None:
    curves = np.array([[0.0, 1.0], [np.nan, np.nan]])
    found = reached(np.array([0.0, 1.0]), curves, np.zeros(2))
    assert found.upper.tolist() == [0.0, 1.0]
    assert found.nearest.tolist() == [0.0, np.inf]


def test_record_that_no_curve_finishes_for_is_far_from_all_sets_and_not_outside() -> None:
    found = reached(np.array([0.0, 1.0]), np.full((3, 2), np.nan), np.zeros(2))
    assert found.outside == 0.0
    assert np.isinf(found.nearest).all()


def test_window_has_its_ends_its_side_and_its_size() -> None:
    study, _ = smoke()
    frame = pd.DataFrame({"time_s": np.arange(6.0), "mlr_kg_m2_s": [0.0, 0.0, 9.0, 9.0, 0.0, 0.0]})
    case = RecordedCases(study.experiments, {("slab_25", "mlr"): frame})
    curves = np.array([[0.0, 1.0, 1.0, 1.0, 1.0, 0.0], [0.0, 2.0, 3.0, 2.0, 3.0, 0.0]])
    one = reached(frame["mlr_kg_m2_s"].to_numpy(), curves, np.zeros(6))
    first, above, last = windows(case, ("slab_25", "mlr"), one)
    assert (above.begins, above.ends, above.above, above.largest) == (2.0, 3.0, True, 7.0)
    assert (first.begins, last.ends) == (1.0, 4.0)
    assert not first.above


# --- causes ---------------------------------------------------------------------------------


def test_corrections_undo_what_their_words_say() -> None:
    study, frames = smoke()
    case = case_of(study, frames)
    channel = "slab_25", "mlr"
    found = list(possible_corrections(case, [channel], [channel]))
    assert len({one.words for one in found}) == len(found)
    (flux,) = [one for one in found if one.words == "the flux of slab_25 is 10 times too large"]
    assert flux.change(case).experiments["slab_25"].front.flux_factor == pytest.approx(0.1)  # type: ignore[attr-defined]
    (tenfold,) = [one for one in found if "slab_25 is 10 times too large: area" in one.words]
    column = "mlr_kg_m2_s"
    made = tenfold.change(case).frames[channel][column]
    assert made.to_numpy() == pytest.approx(0.1 * case.frames[channel][column].to_numpy())
    (swap,) = [one for one in found if one.words == "the files of slab_25 and slab_60 are swapped"]
    assert swap.change(case).frames["slab_60", "mlr"] is case.frames[channel]
    # A record that lies inside for the most part is not wrong by ten.
    rest = [one.words for one in possible_corrections(case, [channel], [])]
    assert not any("10 times too large: area" in words for words in rest)
    assert any("4 times too large: area" in words for words in rest)


def weighed(second: float) -> tuple[RecordedCases, list[LikelyCause]]:
    """Return slabs of 7 kg/m2 and another mass, and the causes that their masses are."""
    study, _ = smoke()
    frames = {}
    experiments = {}
    for name, mass in (("slab_25", 7.0), ("slab_60", second)):
        slab = study.experiments[name]
        assert isinstance(slab, SlabExperiment)
        experiments[name] = changed(slab, signals={"mass": slab.signals["mlr"]})
        frame = pd.DataFrame({"time_s": [0.0, 9.0], "mass_kg_m2": [mass, 0.1 * mass]})
        frames[name, "mass"] = frame.assign(**{NOISE: 0.01})
    case = RecordedCases(experiments, frames)
    causes = possible_corrections(case, [("slab_25", "mass")], [])
    return case, [one for one in causes if one.cause == WEIGHT]


def test_samples_described_alike_that_weigh_differently_are_a_cause() -> None:
    case, (cause,) = weighed(9.0)
    assert cause.places == ("slab_25", "slab_60")
    assert cause.words.startswith("samples described alike weigh 7 to 9 kg/m². Give each")
    made = cause.change(case).experiments
    factors = [made[name].sample.density_factor for name in cause.places]  # type: ignore[attr-defined]
    assert factors == pytest.approx([7.0 / 8.0, 9.0 / 8.0])
    assert weighed(7.1)[1] == []


def test_clock_is_not_late_by_more_than_the_record_is_flat() -> None:
    study, frames = smoke()
    channel = "slab_25", "mlr"
    late = frames[channel].assign(time_s=frames[channel]["time_s"] + 60.0)
    lead = late.iloc[:12].assign(time_s=np.arange(12.0) * 5.0, mlr_kg_m2_s=0.0)
    case = case_of(study, {channel: pd.concat([lead, late], ignore_index=True)})
    words = [one.words for one in possible_corrections(case, [channel], [])]
    assert "the clock of slab_25 is about 60 s late" in words
    # Then 300 s would leave out the test itself: nothing is left to disagree.
    assert "the clock of slab_25 is about 300 s late" not in words
    assert "the clock of slab_25 is about 300 s early" in words


def test_baseline_of_an_instrument_is_a_line_that_leaves_a_usual_specific_heat() -> None:
    described = {
        "kind": "dsc",
        "heating_rate_K_min": 10,
        "start_temperature_K": 300,
        "end_temperature_K": 800,
        "signals": {"heat_flow": {"file": "a.csv"}, "mass_fraction": {"file": "a.csv"}},
    }
    kelvin = np.linspace(300.0, 800.0, 501)
    mass = 1.0 - 0.8 / (1.0 + np.exp((600.0 - kelvin) / 10.0))
    peak = 900.0 * np.exp(-(((kelvin - 600.0) / 20.0) ** 2))
    own = 1500.0 * mass / 6.0
    frame = pd.DataFrame({"time_s": 6.0 * (kelvin - 300.0), "temperature_K": kelvin})
    drift = 40.0 - 5.0 * (kelvin - 300.0)
    frames = {
        ("a", "heat_flow"): frame.assign(heat_flow_W_kg=own + peak + drift),
        ("a", "mass_fraction"): frame.assign(mass_fraction=mass),
    }
    words = "the heat flow of a holds a baseline of the instrument"
    case = RecordedCases({"a": Dsc.model_validate(described)}, frames)
    (one,) = [c for c in possible_corrections(case, list(frames), []) if c.words.startswith(words)]
    assert (one.cause, one.places) == ("baseline of the heat flow", ("a",))
    made = one.change(case).frames["a", "heat_flow"]["heat_flow_W_kg"].to_numpy()
    assert made == pytest.approx(own + peak, abs=1.0)
    given = Dsc.model_validate({**described, "baseline": {"level_W_kg": 5.0}})
    told = possible_corrections(RecordedCases({"a": given}, frames), list(frames), [])
    assert not [c for c in told if c.words.startswith(words)]


@pytest.mark.parametrize("measured", [True, False], ids=["measured times", "times of the rate"])
def test_no_cause_contradicts_the_times_and_the_start_of_a_record(measured: bool) -> None:
    study, _ = smoke()
    key = ("tga_5K", "mass_fraction")
    kelvin = np.linspace(297.0, 900.0, 200)
    time = (kelvin - kelvin[0]) * 12.0
    time[1:-1] += measured * np.random.default_rng(1).normal(0.0, 2.0, 198)
    frame = pd.DataFrame({"time_s": time, "temperature_K": kelvin, "mass_fraction": 1.0})
    case = case_of(study, {key: frame})
    causes = list(possible_corrections(case, [key], []))
    assert not [c for c in causes if "read as K" in c.words]
    assert any(c.cause == "heating rate" for c in causes) != measured


def test_thermocouple_before_a_backing_is_that_of_the_interface() -> None:
    study, frames = smoke()
    channels = [("slab_25", "back_temperature"), ("slab_60", "back_temperature")]
    case = case_of(study, {channel: frames[channel] for channel in channels})
    assert not [
        c for c in possible_corrections(case, channels, []) if c.cause == "place of a thermocouple"
    ]
    for name, slab in case.experiments.items():
        if isinstance(slab, SlabExperiment):
            backing = Backing(component="wool", thickness_m=0.02)
            sample = changed(slab.sample, backing=(backing,))
            case = case.with_experiment(name, changed(slab, sample=sample))
    (found,) = [
        c
        for c in possible_corrections(case, channels[:1], [])
        if c.cause == "place of a thermocouple"
    ]
    assert found.places == ("slab_25", "slab_60")
    made = found.change(case)
    for name, signal in channels:
        moved = made.experiments[name]
        assert moved.quantity(signal).name == "interface_temperature"
        assert moved.signals[signal].layer == 1
        new = made.frames[name, signal][moved.quantity(signal).column]
        assert new.tolist() == case.frames[name, signal]["back_temperature_K"].tolist()


def test_temperatures_in_the_wrong_unit_are_named_first_with_their_window() -> None:
    study, frames = smoke()
    key, column = ("slab_25", "back_temperature"), "back_temperature_K"
    wrong = {**frames, key: frames[key].assign(**{column: frames[key][column] - 273.15})}
    found = preview(study, wrong, 100).found
    assert (found.windows[0].experiment, found.windows[0].signal) == key
    assert not found.windows[0].above
    assert (found.causes[0].cause, found.causes[0].places) == ("unit of temperature", ["slab_25"])
    words = list(sentences_on(study, found))
    assert words[0].startswith("slab_25, back temperature: the data lie below all sets from ")
    assert "the temperatures are in °C, and were read as K" in words[1]


def test_unit_of_a_tiny_record_is_named_though_the_model_misses_another_one() -> None:
    study, frames = smoke()
    rate, back = frames["slab_25", "mlr"], frames["slab_25", "back_temperature"]
    rise = back["back_temperature_K"] - 300.0
    wrong = {
        **frames,
        ("slab_25", "mlr"): rate.assign(mlr_kg_m2_s=1e-3 * rate["mlr_kg_m2_s"]),
        ("slab_25", "back_temperature"): back.assign(back_temperature_K=300.0 + 2.0 * rise),
    }
    (cause,) = preview(study, wrong, 100).found.causes
    assert cause.words.startswith("the mass loss rate of slab_25 is 1000 times too small")


def test_mass_that_ends_below_zero_tells_the_zero_of_the_balance() -> None:
    study, frames = smoke()
    key = "tga_5K", "mass_fraction"
    low = frames[key].assign(mass_fraction=1.15 * frames[key]["mass_fraction"] - 0.15)
    first, *_ = preview(study, {**frames, key: low}, 100).found.causes
    assert first.words == (
        "the zero of the balance of tga_5K is off: the mass fraction ends at "
        f"{low['mass_fraction'].iloc[-1]:.2f}"
    )


def test_words_tell_a_point_repeats_and_sets_that_do_not_finish() -> None:
    given = smoke()[0].model_dump(mode="json", exclude_defaults=True)
    given["experiments"]["slab_25"]["repeats"] = [{}, {}]
    study = as_study(given, "smoke.json")
    left = [NearestSet(experiment="slab_25_1", signal="mlr", left=0.01)]
    kept = {"sets": 300, "nearest": left, "causes": [], "unmoved": []}
    point = Window(
        experiment="slab_60", signal="mlr", begins=9.6, ends=10.3, above=True, largest=1, share=0.1
    )
    unfinished = {"slab_25_1": 24}
    _, reached_all = sentences_on(
        study, Preview(**kept, unfinished=unfinished, windows=[], far=False)
    )
    assert reached_all == (
        "Data against limits: those of 300 sets that finish reach the data of all tests "
        "(1 record, one repeat of each test, and the other repeats)."
    )
    first, *_ = sentences_on(study, Preview(**kept, unfinished={}, windows=[point], far=True))
    assert " all sets at 10 s, by up to" in first
    first, *_ = sentences_on(study, Preview(**kept, unfinished={}, windows=[], far=True))
    assert first.startswith("Each record alone lies within the limits and a margin for noise")


@pytest.mark.parametrize(("peak", "off"), [(0.5, 1.0), (0.01, 10.0), (90.0, 100.0)])
def test_peak_is_set_beside_those_of_most_sets(peak: float, off: float) -> None:
    curves = np.array([[0.0, size] for size in (0.1, 0.1, 0.4, 0.9, 0.9)])
    assert peak_off(np.array([0.0, peak]), curves) == pytest.approx(off)


def test_honest_study_is_not_accused_and_each_test_gets_a_figure(tmp_path: Path) -> None:
    study, frames = smoke()
    made = preview(study, frames)
    assert (made.found.windows, made.found.causes, made.found.far) == ([], [], False)
    assert made.found.unmoved == []
    (sentence,) = sentences_on(study, made.found)
    assert sentence.endswith("300 sets reach the data of all tests (6 records).")
    draw_experiments(study, made.bands, made.found, Results(tmp_path), "figures")
    drawn = {path.stem for path in (tmp_path / "figures").glob("*.png")}
    assert drawn == set(study.experiments)


def test_parameters_that_no_signal_feels_are_named() -> None:
    study, frames = smoke()
    heated = {channel: frame for channel, frame in frames.items() if channel[0].startswith("tga")}
    assert preview(study, heated, 20).found.unmoved == ["rho", "k", "cp", "eps", "dh"]


def test_test_that_no_set_finishes_is_told_and_not_compared() -> None:
    study, frames = smoke()
    hasty = study.accuracy.model_copy(update={"most_steps": 5})
    made = preview(study.model_copy(update={"accuracy": hasty}), frames, 20)
    assert made.found.unfinished == {"slab_25": 20, "slab_60": 20}
    assert {one.experiment for one in made.found.nearest} == {"tga_5K", "tga_20K"}
    assert set(made.bands["experiment"]) == {"tga_5K", "tga_20K"}
    first, *_ = sentences_on(study, made.found)
    assert first == (
        "slab_25: 20 of 20 sets within the limits do not finish; its data are not compared."
    )


def test_study_of_an_external_program_is_told_that_nothing_is_compared() -> None:
    study = read_study(CONFIG / "hotplate.yaml")
    made = preview(study, {("plate_50", "mlr"): pd.DataFrame()})
    assert made.bands.empty
    assert list(sentences_on(study, made.found)) == [
        "Data against limits: pyrofit itself simulates no record; nothing is compared."
    ]


def test_repeats_outside_are_told_beside_the_one_that_is_named() -> None:
    given = smoke()[0].model_dump(mode="json", exclude_defaults=True)
    given["experiments"]["slab_25"]["repeats"] = [{}, {}]
    study = as_study(given, "smoke.json")
    names = "slab_25_1", "slab_25_2"
    windows = [
        Window(
            experiment=name,
            signal="mlr",
            begins=1.0,
            ends=2.0,
            above=True,
            largest=1e-3,
            share=0.1,
        )
        for name in names
    ]
    cause = Likely(cause="flux", places=["slab_25_1"], words="it is", explained=0.9, left=0.01)
    left = [NearestSet(experiment=name, signal="mlr", left=0.3) for name in names]
    found = Preview(
        sets=9, unfinished={}, windows=windows, nearest=left, far=True, causes=[cause], unmoved=[]
    )
    *_, last = sentences_on(study, found)
    assert last == "The same may hold for slab_25_2: repeats of slab_25_1 that lie outside, too."


def test_signals_of_one_quantity_are_told_apart() -> None:
    study, _ = smoke()
    given = study.model_dump(mode="json", exclude_defaults=True)
    signals = given["experiments"]["slab_25"]["signals"]
    signals["lower"] = {**signals["back_temperature"], "quantity": "back_temperature"}
    left = [NearestSet(experiment="slab_25", signal="lower", left=0.3)]
    found = Preview(
        sets=9, unfinished={}, windows=[], nearest=left, far=True, causes=[], unmoved=[]
    )
    first, *_ = sentences_on(as_study(given, "smoke.json"), found)
    assert first.endswith("from slab_25, back temperature (lower) (30 %).")


def with_repeat(factor: float) -> tuple[Study, Frames]:
    """Return the study with a second repeat of a test, whose values are multiplied."""
    study, frames = smoke()
    given = study.model_dump(mode="json", exclude_defaults=True)
    given["experiments"]["slab_60"]["repeats"] = [{}, {}]
    first = frames["slab_60", "mlr"]
    second = first.assign(**{name: factor * first[name] for name in first if name != "time_s"})
    repeats = {("slab_60_1", "mlr"): first, ("slab_60_2", "mlr"): second}
    return as_study(given, "smoke.json"), repeats


@pytest.mark.parametrize(("factor", "rows"), [(1.0, OF_REPEATS), (10.0, 40)])
def test_a_further_repeat_takes_few_sets_unless_it_lies_outside(factor: float, rows: int) -> None:
    study, frames = with_repeat(factor)
    case, sets = case_of(study, frames), draw_sets(study, study.parameters, 40)
    found, every = all_simulated(study, case, sets), simulate_all(study, case, sets)
    first, further = ("slab_60_1", "mlr"), ("slab_60_2", "mlr")
    np.testing.assert_array_equal(found[first], every[first])
    np.testing.assert_array_equal(found[further], every[further][:rows])


def test_repeats_that_end_apart_are_simulated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    study, frames = with_repeat(1.0)
    further = "slab_60_2", "mlr"
    case = case_of(study, {**frames, further: frames[further].iloc[:-40]})
    sets = draw_sets(study, study.parameters, 4)
    calls: list[object] = []

    def counted(experiment: SlabExperiment) -> SimpleNamespace:
        kind = kind_of(experiment)
        run = lambda *given: calls.append(given) or kind.simulate(*given)  # noqa: E731
        return SimpleNamespace(request=kind.request, simulate=run)

    monkeypatch.setattr(reach, "kind_of", counted)
    found = simulate_all(study, case, sets)
    assert len(calls) == 1
    alone = simulate_all(study, case.of([further[0]]), sets)
    assert alone[further].max() > 1e-3
    np.testing.assert_allclose(found[further][:, :-2], alone[further][:, :-2], rtol=1e-9)


def test_no_further_descent_follows_one_that_suffices() -> None:
    study, frames = smoke()
    case = case_of(study, {c: f for c, f in frames.items() if c[0] == "tga_5K"})
    sets = draw_sets(study, study.parameters, 8)
    told: list[bool] = []
    for suffices in (True, False):
        told.clear()
        nearest(
            study,
            case,
            sets,
            simulate_all(study, case, sets),
            lambda left: told.append(bool(left)) or suffices,  # noqa: B023
        )
        assert told == [True] * (1 if suffices else 2)


def test_step_leaves_all_its_files_where_nothing_is_compared(tmp_path: Path) -> None:
    study, results = read_study(CONFIG / "hotplate.yaml"), Results(tmp_path)
    made = preview(study, {("plate_50", "mlr"): pd.DataFrame()})
    write_csv(results.of_step("preview", BANDS), made.bands)
    write(results, made.found)
    PAGE.write(study, results)
    left = {path.name for path in (tmp_path / "preview").iterdir()}
    # The folder of figures is left, too, but it is no output: Snakemake would mark it.
    assert left == {*INPUTS.files, *INPUTS.folders, "figures"}


# --- commands -------------------------------------------------------------------------------


def test_check_with_data_tells_and_draws(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(SMOKE), "--data", "--figures", str(tmp_path / "drawn")]) == 0
    assert "300 sets reach the data of all tests (6 records)" in capsys.readouterr().out
    assert len(list((tmp_path / "drawn").glob("*.svg"))) == 4
