"""Write docs/gallery.md and its figures from the results of shipped studies.

Run: python tools/gallery.py [RESULTS [STUDY ...]]    default: results, all studies

RESULTS holds the results of the commands of the page. All figures that they hold are shown, and
the report as Chromium shows it. The section of a study without results stays as it is.
Titles and captions are those of the report.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from itertools import product
from pathlib import Path

from PIL import Image

from pyrofit.config.read import read_study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show import diagnosis_page
from pyrofit.show.figure import Figure
from pyrofit.show.sections import FIGURES
from pyrofit.steps import known_steps

DOCS = Path(__file__).resolve().parents[1] / "docs"
WIDTHS = (1000, 900, 800, 700, 600)
COLOURS = (64, 16)
MOST_BYTES = 60_000
"""Width, then colours are reduced until a picture has no more bytes."""
SCREEN = (1200, 1500)
"""Part of a report that is shown [pixels]."""
HEAD = """\
# Gallery

Find the figure that you want: the command above it makes it. Pictures, titles and captions are
those of the report, which explains more. The results hold each figure as vector graphics, in the
file that is the alternative text of the picture. The first section has all figures of a study. The
others have the figures that show more. Each section names the commit that drew it.

`python tools/gallery.py` writes this page from the results.
"""
REPORT = "The top of the report"
ENTRY = re.compile(r"### (.*)\n\n!\[(results/.*)\]\((.*)\)\n(?:\n([^#!].*)\n)?")
"""A picture of the page: title, source, path, caption."""
_BROWSER = (
    *("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic"),
    *("--no-first-run", "--disable-background-networking", "--disable-component-update"),
    *("--disable-sync", "--hide-scrollbars", f"--window-size={SCREEN[0]},{SCREEN[1]}"),
)


FOLDERS: dict[str, Mapping[str, Figure]] = {
    "figures": FIGURES,
    **{name: step.load("page").PAGE.figures for name, step in known_steps().items()},
}
"""Figures by folder of the results; those of a diagnosis depend on it."""


@dataclass(frozen=True)
class Group:
    """A section of the page: the figures of one folder of the results of one study."""

    heading: str
    command: str
    study: str
    folder: str = "figures"
    note: str = ""
    report: str = ""
    """Page that is shown as well."""
    only: tuple[str, ...] = ()
    """Names of the figures that are shown; empty: all."""


_K_T = """'synthetic={"effects": {"k_T": {"slope_1_K": -0.001}}}'"""
_CALORIMETRY = "python tests/support/calorimetry_study.py > calorimetry.json"
GROUPS = (
    Group(
        "A study on synthetic data",
        "snakemake --cores 2 --configfile config/twin.yaml",
        "twin",
        report="report.html",
    ),
    Group(
        "Measured PMMA",
        "snakemake --cores 2 --configfile config/pmma.yaml",
        "pmma",
        report="report.html",
        only=(
            *("overview", "fig2", "fig3", "correlation", "profiles"),
            *("fig4", "good_sets", "other_signals", "residuals", "spread"),
        ),
    ),
    Group(
        "The published campaign",
        "snakemake --cores 2 --configfile config/paper.yaml",
        "paper",
        report="report.html",
        only=("overview", "fig3", "fig4", "fig5", "spread"),
    ),
    Group(
        "Measured pine",
        "snakemake --cores 2 --configfile config/pine.yaml",
        "pine",
        report="report.html",
        only=("overview", "fig2", "profiles", "other_signals"),
    ),
    Group(
        "An external program",
        "snakemake --cores 2 --configfile config/hotplate.yaml",
        "hotplate",
        report="report.html",
        only=("overview",),
    ),
    Group(
        "Calorimetry, and an experiment without a measurement",
        f"{_CALORIMETRY}\n    snakemake --cores 2 --configfile calorimetry.json",
        "calorimetry",
        note="The study of a test: one repetition of three generations shows the figures, no "
        "result.",
        only=("heats", "unmeasured"),
    ),
    Group(
        "Diagnosis of a hidden effect",
        f"snakemake --cores 2 diagnose --config name=twin_with_k_T {_K_T}",
        "twin_with_k_T",
        "diagnosis",
        report="diagnosis/report.html",
        only=("mass_loss_rate", "effects", "next_experiments", "profiles", "ranking"),
    ),
    Group(
        "Stability of a diagnosis",
        "snakemake --cores 2 stability --configfile config/pmma.yaml",
        "pmma",
        "stability",
    ),
    Group("Sensitivity", "pyrofit sensitivity config/twin.yaml", "twin", "sensitivity"),
    Group("Posterior", "pyrofit posterior config/twin.yaml", "twin", "posterior"),
    Group("Worth of planned tests", "pyrofit worth config/twin.yaml", "twin", "worth"),
    Group("Stored sets under other costs", "pyrofit rescore config/twin.yaml", "twin", "rescore"),
    Group(
        "Reaction scheme",
        "snakemake --cores 2 scheme --configfile config/smoke.yaml",
        "smoke",
        "scheme",
    ),
    Group(
        "Cost functions on twins with noise and outliers",
        "snakemake --cores 2 robustness --configfile config/smoke.yaml",
        "smoke",
        "robustness",
    ),
)


def main() -> None:
    """Write the page and its figures."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results")
    wanted = sys.argv[2:] or [group.study for group in GROUPS]
    (DOCS / "figures" / "gallery").mkdir(parents=True, exist_ok=True)
    page = DOCS / "gallery.md"
    before = with_captions(sections(page.read_text(encoding="utf-8")))
    parts = [HEAD]
    for group in GROUPS:
        found = group.study in wanted and any(drawn(group, root))
        if found:
            parts.append(section(group, root, "".join(parts)))
        elif group.heading in before:
            parts.append(without_captions(before[group.heading], "".join(parts)))
        print(f"{group.heading}: {'drawn' if found else 'as before'}")
    page.write_text("\n".join(parts), encoding="utf-8")
    remove_unused(page.read_text(encoding="utf-8"))


def sections(text: str) -> dict[str, str]:
    """Return the sections of a page by heading."""
    parts = re.split(r"^(?=## )", text, flags=re.M)[1:]
    return {part.partition("\n")[0].removeprefix("## "): part.rstrip("\n") + "\n" for part in parts}


def with_captions(before: Mapping[str, str]) -> dict[str, str]:
    """Return sections in which each picture has its caption: its own, or the last one above.

    A section that is not drawn anew keeps the captions of its pictures so.
    """
    captions: dict[str, str] = {}

    def completed(found: re.Match[str]) -> str:
        title, source, path, caption = found.groups()
        caption = caption or captions.get(figure_of(source), "")
        captions[figure_of(source)] = caption
        return entry(title, path, caption, source)

    return {heading: ENTRY.sub(completed, text) for heading, text in before.items()}


def without_captions(text: str, above: str) -> str:
    """Return a section without the captions that are the last ones above."""
    last = last_captions(above)

    def shortened(found: re.Match[str]) -> str:
        title, source, path, caption = found.groups()
        again = caption == last.get(figure_of(source))
        return entry(title, path, "" if again or not caption else caption, source)

    return ENTRY.sub(shortened, text)


def last_captions(above: str) -> dict[str, str]:
    """Return the last caption of each figure that stands in a part of the page."""
    found = ENTRY.findall(above)
    return {figure_of(source): caption for _, source, _, caption in found if caption}


def figure_of(source: str) -> str:
    """Return folder and name of a figure in the results of any study.

    >>> figure_of("results/twin/figures/fig2.svg")
    'figures/fig2.svg'
    """
    return source.split("/", 2)[2]


def section(group: Group, root: Path, above: str) -> str:
    """Draw the pictures of a group and return its section of the page.

    A caption that stands in a section above is not repeated.
    """
    parts = [f"## {group.heading}\n\n    {group.command}\n", drawn_at()]
    if group.note:
        parts.append(f"{group.note}\n")
    for figure, source in drawn(group, root):
        target = picture(f"{group.study}_{group.folder}_{source.stem}")
        with Image.open(source) as image:
            shrink(image, target)
        name = f"results/{source.relative_to(root).with_suffix('.svg').as_posix()}"
        again = first_sentence(figure.caption) == last_captions(above).get(figure_of(name))
        caption = "" if again else first_sentence(figure.caption)
        parts.append(entry(figure.title, shown(target), caption, name))
    page = root / group.study / group.report
    if group.report and page.is_file():
        target = picture(
            f"{group.study}_{Path(group.report).parent.name}_report".replace("__", "_")
        )
        shrink(screenshot(page), target)
        source_of = f"results/{page.relative_to(root).as_posix()}"
        parts.append(entry(REPORT, shown(target), "", source_of))
    return "\n".join(parts)


def first_sentence(caption: str) -> str:
    """Return the beginning of a caption; the report has all of it.

    >>> first_sentence("Mass, 2.5 mm. Thin: data.")
    'Mass, 2.5 mm.'
    """
    return re.split(r"(?<=\.) ", caption, maxsplit=1)[0]


def drawn(group: Group, root: Path) -> Iterator[tuple[Figure, Path]]:
    """Yield the figures of a group that its results hold, and their files."""
    folder = root / group.study / group.folder
    if group.folder == "figures" and not (root / group.study / "report.html").is_file():
        return  # not finished
    figures = of_diagnosis(root / group.study) if group.folder == "diagnosis" else None
    for name, figure in (FOLDERS[group.folder] if figures is None else figures).items():
        source = folder / f"{name}.png"
        if source.is_file() and (name in group.only or not group.only):
            yield figure, source


def of_diagnosis(root: Path) -> dict[str, Figure]:
    """Return the figures of a diagnosis; none where there is no diagnosis."""
    results = Results(root)
    study = read_study(root / "study.json")
    if not diagnosis_page.is_drawn(study, results):
        return {}
    return dict(diagnosis_page.page_of_diagnosis(study, diagnosis.read(study, results)).figures)


def picture(name: str) -> Path:
    """Return the file of a picture of the page."""
    return DOCS / "figures" / "gallery" / f"{name}.png"


def shrink(drawn: Image.Image, target: Path) -> None:
    """Write a picture in few colours, with as many pixels as its size allows."""
    flat = drawn.convert("RGB")
    for colours, width in product(COLOURS, WIDTHS):
        size = min(width, flat.width), round(flat.height * min(width, flat.width) / flat.width)
        small = flat.resize(size, Image.Resampling.LANCZOS)
        # This method keeps the colours of thin lines.
        few = small.quantize(colours, method=Image.Quantize.MAXCOVERAGE, kmeans=3)
        whiten(few)
        few.save(target, optimize=True)
        if target.stat().st_size <= MOST_BYTES:
            return
    raise SystemExit(f"{target} is larger than {MOST_BYTES} bytes in the smallest form")


def whiten(few: Image.Image) -> None:
    """Make the lightest grey of a picture white again, which the choice of colours may darken."""
    palette = few.getpalette() or []
    colours = [palette[i : i + 3] for i in range(0, len(palette), 3)]
    lightest = max(colours, key=min)
    few.putpalette([x for one in colours for x in ([255] * 3 if one == lightest else one)])


def screenshot(page: Path) -> Image.Image:
    """Return the top of a page as a browser shows it."""
    if shutil.which(_BROWSER[0]) is None:
        raise SystemExit(f"{_BROWSER[0]} is not there; it takes the pictures of the reports")
    with tempfile.TemporaryDirectory() as folder:
        shot = Path(folder) / "shot.png"
        own = f"--user-data-dir={folder}/user", f"--screenshot={shot}"
        command = [*_BROWSER, *own, page.resolve().as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        return Image.open(BytesIO(shot.read_bytes()))


def entry(title: str, path: str, caption: str, source: str) -> str:
    """Return the part of the page for one picture."""
    said = f"\n{caption}\n" if caption else ""
    return f"### {title}\n\n![{source}]({path})\n{said}"


def shown(target: Path) -> str:
    """Return the path of a picture as the page names it."""
    return target.relative_to(DOCS).as_posix()


def drawn_at() -> str:
    """Return the line that tells with which version of the code a section was drawn."""
    command = ["git", "rev-parse", "--short=8", "HEAD"]
    found = subprocess.run(command, check=True, capture_output=True, text=True, cwd=DOCS)
    return f"Drawn at commit {found.stdout.strip()}.\n"


def remove_unused(text: str) -> None:
    """Delete pictures that the page does not show."""
    for path in (DOCS / "figures" / "gallery").glob("*.png"):
        if path.name not in text:
            path.unlink()


if __name__ == "__main__":
    main()
