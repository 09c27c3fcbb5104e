"""The report as a reader sees it: opened in a browser without a window, where there is one."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from tiny import Project

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
WIDTHS = (1100, 390)

# The page stands in a frame: a window is 500 pixels wide at least.
FRAME = """<!doctype html><meta charset="utf-8"><body><script>
const page = {page};
const found = {{}};
const shown = (e) => e.getClientRects().length > 0;
const words = (e) => (e.innerText || e.alt || e.id).slice(0, 50);
const called = (e) => `${{e.tagName.toLowerCase()}} "${{words(e)}}"`;

function look(frame) {{
  const view = frame.contentDocument, width = view.documentElement.clientWidth;
  const inBox = (e) => e.closest(".wide, pre, dialog");
  const all = [...view.body.querySelectorAll("*")].filter(shown);
  const wide = all.filter((e) => !inBox(e) || e.matches(".wide, pre"))
    .filter((e) => e.getBoundingClientRect().right > width + 1).map(called);
  const texts = all.filter((e) => e.matches("h1,h2,h3,h4,p,li,figcaption,.wide,.bar,nav,pre"));
  const overlaps = [];
  texts.forEach((a, i) => texts.slice(i + 1).forEach((b) => {{
    if (a.contains(b)) return;
    const p = a.getBoundingClientRect(), q = b.getBoundingClientRect();
    const x = Math.min(p.right, q.right) - Math.max(p.left, q.left);
    const y = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
    if (x > 1 && y > 1) overlaps.push(`${{called(a)}} and ${{called(b)}}`);
  }}));
  const cells = all.filter((e) => e.matches("th, td") && e.scrollWidth > e.clientWidth + 1);
  const images = [...view.images].filter((e) => !e.closest("dialog"));
  return {{
    width, wide, overlaps, cells: cells.map(called),
    scroll: view.documentElement.scrollWidth,
    headings: texts.filter((e) => e.matches("h2")).length,
    images: images.map((e) => ({{
      name: e.alt, decoded: e.complete && e.naturalWidth > 0 && e.naturalHeight > 0,
      width: e.getBoundingClientRect().width, height: e.getBoundingClientRect().height,
    }})),
  }};
}}

function use(frame) {{
  const view = frame.contentDocument, box = view.querySelector("dialog");
  const button = view.querySelector("button.enlarge");
  button.click();
  const opened = box.open && box.querySelector("img").getBoundingClientRect().width > 300;
  box.click();
  const toggle = view.querySelector(".toggle"), cost = toggle.dataset.toggles;
  const rows = [...view.querySelectorAll(`[data-cost="${{cost}}"]`)];
  const before = rows.filter(shown).length;
  toggle.click();
  const hidden = rows.filter(shown).length;
  toggle.click();
  return {{ opened, closed: !box.open, before, hidden, after: rows.filter(shown).length }};
}}

async function main() {{
  for (const width of {widths}) {{
    const frame = document.createElement("iframe");
    frame.style = `border: 0; height: 900px; width: ${{width}}px`;
    frame.srcdoc = page;
    const loaded = new Promise((resolve) => (frame.onload = resolve));
    document.body.append(frame);
    await loaded;
    frame.contentDocument.querySelectorAll("details").forEach((one) => (one.open = true));
    await Promise.all([...frame.contentDocument.images].map((i) => i.decode().catch(() => {{}})));
    found[width] = {{ ...look(frame), ...use(frame) }};
  }}
}}
main().catch((error) => console.error(String(error))).finally(() => {{
  document.body.textContent = JSON.stringify(found);
}});
</script>"""


def opened(page: str, folder: Path) -> tuple[dict[str, Any], list[str]]:
    """Return what a browser shows of a page by width, and what it says on its console."""
    if BROWSER is None:
        pytest.skip(f"no browser to open the page with: none of {', '.join(BROWSERS)} is installed")
    frame = folder / "frame.html"
    inside = json.dumps(page).replace("</", "<\\/")
    frame.write_text(FRAME.format(page=inside, widths=json.dumps(WIDTHS)), encoding="utf-8")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage")
    profile = f"--user-data-dir={folder / 'profile'}"
    logs = ("--enable-logging=stderr", "--virtual-time-budget=20000", "--dump-dom")
    run = subprocess.run(
        [BROWSER, *options, profile, *logs, frame.as_uri()],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    body = re.search(r"<body>(.*)</body>", run.stdout, re.S)
    assert body, run.stderr[-2000:]
    console = re.findall(r"CONSOLE.*", run.stderr)
    assert body[1].startswith("{"), console
    return json.loads(html.unescape(body[1])), console


@pytest.fixture(scope="module")
def seen(
    finished: tuple[Project, Any], tmp_path_factory: pytest.TempPathFactory
) -> tuple[dict[str, Any], list[str], str]:
    page = finished[0].root / "results" / "tiny" / "report.html"
    text = page.read_text(encoding="utf-8")
    return *opened(text, tmp_path_factory.mktemp("page")), text


def test_browser_reports_no_error(seen: tuple[dict[str, Any], list[str], str]) -> None:
    assert seen[1] == []


@pytest.mark.parametrize("width", WIDTHS)
class TestPage:
    """What holds at the width of a desk and of a phone."""

    @pytest.fixture
    def shown(self, seen: tuple[dict[str, Any], list[str], str], width: int) -> dict[str, Any]:
        found: dict[str, Any] = seen[0][str(width)]
        # A scroll bar takes some pixels.
        assert width - 20 <= found["width"] <= width
        return found

    def test_all_figures_are_decoded_and_visible(
        self, shown: dict[str, Any], seen: tuple[dict[str, Any], list[str], str]
    ) -> None:
        assert len(shown["images"]) == seen[2].count("<figure ") > 10
        assert [i["name"] for i in shown["images"] if not i["decoded"]] == []
        small = [i for i in shown["images"] if i["width"] < 200 or i["height"] < 80]
        assert small == []

    def test_nothing_is_wider_than_the_window(self, shown: dict[str, Any]) -> None:
        assert shown["wide"] == []
        assert shown["scroll"] <= shown["width"]

    def test_no_text_overlaps_another(self, shown: dict[str, Any]) -> None:
        assert shown["headings"] >= 9
        assert shown["overlaps"] == []
        assert shown["cells"] == []

    def test_figure_opens_over_the_window_and_closes_again(self, shown: dict[str, Any]) -> None:
        assert shown["opened"]
        assert shown["closed"]

    def test_cost_function_is_hidden_in_all_tables_and_shown_again(
        self, shown: dict[str, Any]
    ) -> None:
        assert shown["before"] > 3
        assert shown["hidden"] == 0
        assert shown["after"] == shown["before"]


def test_what_looks_at_the_page_sees_what_is_wrong(tmp_path: Path) -> None:
    bad = (
        '<!doctype html><body data-costs="[]"><h2>One</h2><h2 style="margin-top:-3em">Two</h2>'
        '<p style="width:2000px">wide</p><script>missing()</script><dialog><img></dialog>'
        '<button class="enlarge"><img alt="broken" src="data:image/svg+xml,"></button>'
        '<table><tr data-cost="a"><td><button class="toggle" data-toggles="a"></button></table>'
    )
    found, console = opened(bad, tmp_path)
    assert "missing is not defined" in " ".join(console)
    for shown in found.values():
        assert 'h2 "One" and h2 "Two"' in shown["overlaps"]
        assert shown["wide"] == ['p "wide"']
        assert [i["decoded"] for i in shown["images"]] == [False]
        assert not shown["opened"]
        assert shown["hidden"] == shown["before"]
