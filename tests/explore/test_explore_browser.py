"""The page of the explorer in a real browser."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import Browser, lacking, until

from pyrofit.explore.run import Explorer
from pyrofit.explore.server import in_background

pytestmark = pytest.mark.skipif(bool(lacking()), reason=f"not here: {lacking()}")
SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


@pytest.fixture(scope="module")
def explorer() -> Iterator[Explorer]:
    made = Explorer(SMOKE, Path("no results"))
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
    return browser.run("return [...page.plots[arguments[0]].first]", signal)


def moved(browser: Browser, name: str, share: float) -> None:
    """Move a slider, and wait for the curves."""
    script = """
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
    browser.run(script, name, share)


def test_a_slider_moves_the_curves(browser: Browser, explorer: Explorer) -> None:
    opened(browser, explorer.address)
    assert browser.run("return byId('error').textContent") == ""
    before = {s: curve(browser, s) for s in ("tga_5K/mass_fraction", "slab_25/mlr")}
    moved(browser, "dh", 0.9)
    assert curve(browser, "tga_5K/mass_fraction") == before["tga_5K/mass_fraction"]
    assert curve(browser, "slab_25/mlr") != before["slab_25/mlr"]
