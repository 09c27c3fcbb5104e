"""The page of the explorer in a real browser."""

import json
import threading
import time
from collections.abc import Iterator, Mapping
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from browser import Browser, lacking, until
from published_material import VARYING, kinetics_alone, of_thermal, published, second_reaction

import pyrofit as pf
from pyrofit.cli import main
from pyrofit.config import Study
from pyrofit.data.fetch import FOLDER_VARIABLE
from pyrofit_explore.describe import in_shown_units
from pyrofit_explore.fit import Send
from pyrofit_explore.run import Explorer
from pyrofit_explore.server import in_background
from pyrofit_explore.session import Session, State, session_of
from pyrofit_explore.static import write_static

pytestmark = pytest.mark.skipif(bool(lacking()), reason=f"not here: {lacking()}")
ROOT = Path(__file__).parents[3]
SMOKE = ROOT / "config" / "smoke.yaml"
SLAB, TGA = "slab_25/mlr", "tga_5K/mass_fraction"
MOVE = """
const slider = document.querySelector(`#row-${arguments[0]} input[type=range]`);
const n = page.delays.length;
slider.value = 1000 * arguments[1];
slider.dispatchEvent(new Event("input"));
slider.dispatchEvent(new Event("change"));
return new Promise(done => {
    const look = () => page.delays.length > n && !busy ? done(true) : setTimeout(look, 5);
    look();
});
"""


@pytest.fixture(scope="module")
def explorer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Explorer]:
    compiled = session_of(SMOKE, noise=False)
    compiled.curves(State({}))  # no test waits for the compiler
    made = Explorer(SMOKE, tmp_path_factory.mktemp("results"))
    in_background(made.server)
    yield made
    made.close()


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    made = Browser()
    yield made
    made.close()


def opened(browser: Browser, address: str) -> None:
    browser.open("about:blank")
    browser.open(address)
    shown = "return typeof page == 'object' && (!byId('error').hidden || page.delays.length > 0)"
    until(lambda: browser.run(shown), "the page")


def curve(browser: Browser, signal: str) -> list[float]:
    found: list[float] = browser.run("return [...page.plots[arguments[0]].first]", signal)
    return found


def error(browser: Browser) -> str:
    return str(browser.run("return byId('error').hidden ? '' : byId('error').textContent"))


def settled(browser: Browser) -> None:
    until(lambda: browser.run("return !busy && !fitting"), "the curves")


def test_a_slider_moves_the_curves_and_undo_moves_them_back(
    browser: Browser, explorer: Explorer
) -> None:
    opened(browser, explorer.address)
    assert error(browser) == ""
    before = {s: curve(browser, s) for s in (TGA, SLAB)}
    browser.run(MOVE, "dh", 0.9)
    assert curve(browser, TGA) == before[TGA]
    assert curve(browser, SLAB) != before[SLAB]
    browser.click("#undo")
    settled(browser)
    assert curve(browser, SLAB) == before[SLAB]


def measured(folder: Path) -> Study:
    """Return the study with its curves in files, as if they were measured."""
    keys = json.loads(json.dumps(yaml.safe_load(SMOKE.read_text())))  # aliases are copies
    truth = keys.pop("synthetic")["truth"]
    del keys["imp"]["costs"]["BANDS"]  # the files state no uncertainty
    unit = {"mass_fraction": "-", "mlr": "kg/m2/s", "back_temperature": "K"}
    for (name, signal), frame in pf.simulate(pf.read_study(SMOKE), truth).series.items():
        roles = {"time": "time_s", "temperature": "temperature_K", "value": frame.columns[-1]}
        roles = {role: column for role, column in roles.items() if column in frame}
        path = folder / f"{name}_{signal}.csv"
        pd.DataFrame({r: frame[c] for r, c in roles.items()}).to_csv(path, index=False)
        units = {"time": "s", "temperature": "K", "value": unit[signal]}
        given = keys["experiments"][name]["signals"][signal]
        kept = {"average_s": given["average_s"]} if "average_s" in given else {}
        read = {"columns": {r: r for r in roles}, "units": {r: units[r] for r in roles}}
        keys["experiments"][name]["signals"][signal] = {"file": str(path), **kept, **read}
    return pf.read_study(keys)


def test_a_published_material_is_started_from(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "Polymer" / "Material_Properties"
    folder.mkdir(parents=True)
    for name, changes in (
        ("A", [of_thermal("Conductivity", VARYING)]),
        ("B", [second_reaction, kinetics_alone]),
    ):
        (folder / f"{name}.json").write_text(published(*changes).strict.text())
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    made = Explorer(measured(tmp_path), tmp_path)
    in_background(made.server)
    try:
        opened(browser, made.address)
        assert error(browser) == ""
        entries = browser.run(
            "return [...document.querySelectorAll('#start option')].slice(-2)"
            ".map(o => [o.textContent, o.disabled])"
        )
        assert entries == [["MaCFP: A", False], ["MaCFP: B: nothing to take", True]]
        browser.run(MOVE, "k", 0.9)
        browser.run(
            "const s = document.querySelector('#start'); s.value = 'published:A';"
            "s.dispatchEvent(new Event('change'));"
        )
        settled(browser)
        said = str(browser.run("return byId('message').textContent"))
        values = browser.run("return page.values")
        assert said.startswith("MaCFP: A. Taken: T_p ")
        assert "Not taken: k (varies with temperature there)." in said
        assert "\n" not in said
        assert (values["rho"], values["dh"]) == (1190, 800)
        assert values["k"] == pytest.approx(0.37)
        shown = browser.run("return document.querySelector('#row-rho input[type=number]').value")
        assert shown == "1190"
        browser.click("#undo")
        settled(browser)
        assert browser.run("return page.values.rho") != 1190
    finally:
        made.close()


PAINTED = """
const slider = document.querySelector(`#row-k input[type=range]`);
const frame = () => new Promise(done => requestAnimationFrame(done));
const drawn = () => new Promise(done => { page.delays.push = done; });
return (async () => {
    const found = [];
    for (let i = 0; i < 40; i++) {
        await new Promise(done => setTimeout(done, 30));
        const begin = performance.now();
        slider.value = 300 + 10 * i;
        slider.dispatchEvent(new Event("input"));
        await drawn();
        await frame();
        await new Promise(done => setTimeout(done, 0));  // the frame with the curves is made
        found.push(performance.now() - begin);
    }
    return found;
})();
"""


def test_twenty_curves_are_painted_within_50_ms_of_a_slider(
    browser: Browser, twenty: Study
) -> None:
    # Other programs prolong the delays, but not the time of the processor.
    made = Explorer(twenty)
    in_background(made.server)
    try:
        opened(browser, made.address)
        until(lambda: made.session.noise, "the noise")
        browser.run(PAINTED)
        begin = browser.processor_s() + time.process_time()
        delays = np.array(browser.run(PAINTED))
        spent = (browser.processor_s() + time.process_time() - begin) / delays.size
    finally:
        made.close()
    median, largest = np.median(delays), delays.max()
    print(f"slider to picture: median {median:.0f}, largest {largest:.0f}", end=" ms; ")
    print(f"processors, server and browser: {1e3 * spent:.0f} ms a picture")
    assert min(spent, 1e-3 * median) < 0.05


def test_page_asks_no_other_host(browser: Browser, explorer: Explorer) -> None:
    opened(browser, explorer.address)
    names = browser.run("return performance.getEntriesByType('resource').map(e => e.name)")
    assert names
    assert {name.rsplit("/", 1)[0] for name in names} == {explorer.server.origin}


def test_an_effect_is_a_switch_with_a_strength(browser: Browser, explorer: Explorer) -> None:
    opened(browser, explorer.address)
    before = curve(browser, SLAB)
    browser.run("document.querySelector('#compare').value = 'keep'; compare('keep')")
    browser.click("#effect-flux_spread input")
    settled(browser)
    spread = curve(browser, SLAB)
    assert spread != before
    assert browser.run(f"return [...page.plots['{SLAB}'].second]") == before
    browser.run(MOVE, "flux_spread_spread", 0.0)
    assert curve(browser, SLAB) == before
    assert error(browser) == ""


def test_a_link_restores_the_state(browser: Browser, explorer: Explorer) -> None:
    opened(browser, explorer.address)
    browser.run(MOVE, "k", 0.8)
    browser.click("#effect-flux_spread input")
    settled(browser)
    there, link = curve(browser, SLAB), browser.run("return location.href")
    opened(browser, link)
    settled(browser)
    assert curve(browser, SLAB) == there


def test_fit_save_and_the_saved_study_has_the_same_curves(
    browser: Browser, explorer: Explorer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    opened(browser, explorer.address)
    browser.run("start('truth')")
    browser.run(MOVE, "k", 0.7)
    browser.click("#fit")
    done = "return byId('message').textContent.startsWith('The fit has ended')"
    until(lambda: browser.run(done), "the fit", 200.0)
    settled(browser)
    fitted = browser.run("return page.values")
    assert fitted["k"] == pytest.approx(0.2, abs=0.03)
    mine = {s: curve(browser, s) for s in (TGA, SLAB, "slab_60/mlr")}
    browser.click("#save")
    until(lambda: (tmp_path / "smoke_explored.json").exists(), "the files")
    until(lambda: "pyrofit run" in browser.run("return byId('message').textContent"), "words")
    study = pf.read_study("smoke_explored.yaml")
    values = json.loads((tmp_path / "smoke_explored.json").read_text())["values_SI"]
    assert values["dh"] == pytest.approx(1e3 * fitted["dh"])
    again = Explorer(tmp_path / "smoke_explored.yaml", None, "smoke_explored.json")
    in_background(again.server)
    try:
        opened(browser, again.address)
        browser.run("start('smoke_explored.json')")
        settled(browser)
        for signal, own in mine.items():
            assert curve(browser, signal) == own
    finally:
        again.close()
    # The estimates of a run of the saved study describe the fitted signals with the same curves.
    run = ["run", "smoke_explored.yaml", "--cores", "1"]
    assert main(run) == 0
    estimates = pf.read_results("results/smoke_explored").values
    found = pf.simulate(study, estimates)
    scored = pf.simulate(study, {n: fitted[n] for n in study.parameters})
    for key in (("slab_25", "mlr"), ("tga_5K", "mass_fraction")):
        column = study.experiments[key[0]].quantity(key[1]).column
        y, f = found[key][column].to_numpy(), scored[key][column].to_numpy()
        assert np.sqrt(np.mean((y - f) ** 2)) < 0.02 * np.ptp(f)


def test_a_browser_that_is_closed_ends_its_fit(
    browser: Browser, explorer: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = []

    def fit(given: Mapping[str, object], send: Send) -> None:
        try:
            while True:
                send({"said": "The fit goes on"})
                time.sleep(0.05)
        finally:
            ended.append(True)

    monkeypatch.setattr(explorer.server, "streams", {"fit": fit})
    other = Browser()
    try:
        opened(other, explorer.address)
        other.run("fit()")
        goes_on = "return byId('message').textContent == 'The fit goes on'"
        until(lambda: other.run(goes_on), "the fit")
        assert not ended
    finally:
        other.close()
    until(lambda: ended, "the end of the fit")
    opened(browser, explorer.address)
    browser.run(MOVE, "k", 0.4)
    assert error(browser) == ""


def test_hover_tells_values_and_units_and_a_drag_zooms(
    browser: Browser, explorer: Explorer
) -> None:
    opened(browser, explorer.address)
    browser.run(
        """
        const plot = page.plots[arguments[0]], canvas = plot.canvas;
        window.at = (name, x) => canvas.dispatchEvent(new PointerEvent(name, {
            clientX: canvas.getBoundingClientRect().left + plot.left + x * plot.width,
            clientY: canvas.getBoundingClientRect().top + 50, bubbles: true,
        }));
        at("pointermove", 0.5);
        """,
        SLAB,
    )
    said = browser.run("return page.plots[arguments[0]].tip.textContent", SLAB).splitlines()
    assert [line.split()[0] for line in said] == ["time", "measured", "simulated"]
    assert said[0].endswith(" s")
    assert all(line.endswith(" g/(m² s)") for line in said[1:])
    ends = "const p = page.plots[arguments[0]]; return [p.x0, p.x1];"
    first, last = browser.run(ends, SLAB)
    browser.run("at('pointerdown', 0.25); at('pointerup', 0.5);")
    zoomed = browser.run(ends, SLAB)
    assert zoomed == pytest.approx([0.75 * first + 0.25 * last, 0.5 * (first + last)], rel=1e-3)
    browser.run("at('dblclick', 0.5)")
    assert browser.run(ends, SLAB) == [first, last]


def test_a_known_value_is_marked_on_its_slider(
    browser: Browser, session: Session, tmp_path: Path
) -> None:
    study = pf.read_study(session.study, known={"k": {"value": 0.2, "sd": 0.02, "source": "table"}})
    made = Explorer(study, tmp_path)
    in_background(made.server)
    try:
        opened(browser, made.address)
        marks = browser.run(
            "return [...document.querySelectorAll('.mark')].map(m => m.closest('.row').id)"
        )
        assert marks == ["row-k"]
        mark, rail = browser.run(
            """
            const mark = document.querySelector(".mark"), rail = mark.parentElement;
            return [mark.getBoundingClientRect().left - rail.getBoundingClientRect().left,
                    rail.getBoundingClientRect().width];
            """
        )
        k = study.parameters["k"]
        assert mark == pytest.approx(8 + (rail - 16) * (0.2 - k.lower) / (k.upper - k.lower), abs=2)
        assert browser.run("return page.values.k") == pytest.approx(0.2)
    finally:
        made.close()


def test_a_fit_can_be_cancelled(browser: Browser, explorer: Explorer) -> None:
    opened(browser, explorer.address)
    browser.run("fit(); byId('cancel').click();")
    cancelled = "return byId('message').textContent.startsWith('The fit was cancelled')"
    until(lambda: browser.run(cancelled), "the end of the fit")
    assert not browser.run("return byId('fit').disabled")
    browser.run(MOVE, "k", 0.6)
    assert error(browser) == ""


def test_a_broken_study_shows_its_error_until_it_is_corrected(
    browser: Browser, tmp_path: Path
) -> None:
    good = SMOKE.read_text(encoding="utf-8")
    path = tmp_path / "broken.yaml"
    path.write_text(good.replace("conductivity_W_mK: k,", "conductivity_W_mK: kk,"), "utf-8")
    made = Explorer(path, tmp_path)
    in_background(made.server)
    try:
        opened(browser, made.address)
        assert "unknown parameter 'kk'" in error(browser)
        assert "broken.yaml" in error(browser)
        path.write_text(good, encoding="utf-8")
        opened(browser, made.address)
        assert error(browser) == ""
        assert len(curve(browser, SLAB)) > 100
    finally:
        made.close()


def test_two_pages_at_once_do_not_disturb_each_other(browser: Browser, explorer: Explorer) -> None:
    other = Browser()
    try:
        opened(browser, explorer.address)
        opened(other, explorer.address)
        browser.run(MOVE, "dh", 0.2)
        mine = curve(browser, SLAB)
        other.run(MOVE, "dh", 0.8)
        browser.run(MOVE, "eps", 0.5)
        assert curve(other, SLAB) != mine
        browser.run(MOVE, "dh", 0.8)
        other.run(MOVE, "eps", 0.5)
        assert curve(other, SLAB) == curve(browser, SLAB)
    finally:
        other.close()
    browser.run(MOVE, "dh", 0.3)
    assert error(browser) == ""


def test_a_failing_simulation_is_told_and_the_page_goes_on(
    browser: Browser, explorer: Explorer
) -> None:
    opened(browser, explorer.address)
    browser.run("page.values.k = -1; refresh()")
    until(lambda: "'k': -1" in error(browser), "the error")
    browser.run(MOVE, "k", 0.5)
    assert error(browser) == ""


def test_ten_thousand_slider_events_end_at_the_last_value(
    browser: Browser, explorer: Explorer
) -> None:
    opened(browser, explorer.address)
    count = browser.run(
        """
        const slider = document.querySelector("#row-dh input[type=range]");
        const n = page.delays.length;
        return new Promise(done => {
            let i = 0;
            const look = () => busy ? setTimeout(look, 5) : done(page.delays.length - n);
            const burst = () => {
                for (let j = 0; j < 100; j++, i++) {
                    slider.value = i % 1000;
                    slider.dispatchEvent(new Event("input"));
                }
                if (i < 10000) setTimeout(burst, 1);
                else look();
            };
            burst();
        });
        """
    )
    assert 1 < count < 10_000
    end = curve(browser, SLAB)
    browser.run(MOVE, "dh", 0.1)
    browser.run(MOVE, "dh", 0.999)
    assert curve(browser, SLAB) == end


def test_the_page_of_another_origin_cannot_use_it(browser: Browser, explorer: Explorer) -> None:
    class Other(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.end_headers()
            self.wfile.write(b"<title>other</title>")

        def log_message(self, format: str, *args: object) -> None:
            pass

    site = HTTPServer(("127.0.0.1", 0), Other)
    threading.Thread(target=site.serve_forever, daemon=True).start()
    try:
        browser.open(f"http://127.0.0.1:{site.server_port}/")
        script = """
        const [address, token, mode] = arguments, headers = token ? {"X-Token": token} : {};
        return fetch(address, {method: "POST", body: "{}", headers, mode})
            .then(r => r.type == "opaque" ? "opaque" : "answered " + r.status, e => "refused");
        """
        address = f"{explorer.server.origin}/describe"
        assert browser.run(script, address, explorer.server.token, "cors") == "refused"
        assert browser.run(script, address, "", "cors") == "refused"
        assert browser.run(script, address, "", "no-cors") == "opaque"  # 403, unread
    finally:
        site.shutdown()
        site.server_close()


def test_a_page_without_a_server_follows_its_sliders(
    browser: Browser, session: Session, tmp_path: Path
) -> None:
    path = tmp_path / "page.html"
    write_static(session, ["dh", "k"], "truth", path)
    opened(browser, path.as_uri())
    assert error(browser) == ""
    browser.run(MOVE, "dh", 0.43)
    of_page = np.array(curve(browser, SLAB))
    values = {**session.sets["truth"], **browser.run("return page.values")}
    signals = [s["id"] for s in session.description()["signals"]]
    model, simulated = session.simulate(State(values))
    i = signals.index(SLAB)
    own = in_shown_units(model, i, simulated.models[i])
    assert np.sqrt(np.mean((of_page - own) ** 2)) < 0.02 * np.ptp(own)
