"""Write docs/gallery.md and its figures from the results of shipped studies.

Run: python tools/gallery.py [RESULTS]    default: results

RESULTS holds twin, pmma, paper, pine and twin_with_k_T, finished with the commands of the page.
Titles and captions are those of the report.
"""

import sys
from pathlib import Path

from PIL import Image

from pyrofit.show import diagnosis_page
from pyrofit.show.figure import Figure
from pyrofit.show.posterior.figures import FIGURES as POSTERIOR
from pyrofit.show.sections import FIGURES
from pyrofit.show.sensitivity.figures import FIGURES as SENSITIVITY

DOCS = Path(__file__).resolve().parents[1] / "docs"
WIDTH = 1100
COLOURS = 64
HEAD = """\
# Gallery

Figures of the shipped studies. The command that makes the figures of a section stands above them,
and the name of the file below each. Titles and captions are those of the report, which has these
figures as vector graphics.

`python tools/gallery.py` writes this page from the results.
"""
_HIDDEN = (
    "snakemake --cores 2 diagnose --config name=twin_with_k_T "
    """'synthetic={"effects": {"k_T": {"slope_1_K": -0.001}}}'"""
)
Group = tuple[str, str, str, str, dict[str, Figure], tuple[str, ...]]
"""Heading, command, study, folder of its figures, figures by name, and the names to show."""
GROUPS: tuple[Group, ...] = (
    (
        "A study on synthetic data",
        "snakemake --cores 2 --configfile config/twin.yaml",
        "twin",
        "figures",
        FIGURES,
        (
            *("overview", "fig1", "fig2", "fig3", "fig4", "profiles"),
            *("good_sets", "residuals", "fig5", "spread", "optimisers"),
        ),
    ),
    (
        "Measured PMMA",
        "snakemake --cores 2 --configfile config/pmma.yaml",
        "pmma",
        "figures",
        FIGURES,
        ("overview", "kinetics_all_rates", "other_signals", "profiles"),
    ),
    (
        "The published campaign",
        "snakemake --cores 2 --configfile config/paper.yaml",
        "paper",
        "figures",
        FIGURES,
        ("fig2", "fig3", "fig4", "fig5", "spread"),
    ),
    (
        "Measured pine",
        "snakemake --cores 2 --configfile config/pine.yaml",
        "pine",
        "figures",
        FIGURES,
        ("kinetics_all_rates", "other_signals"),
    ),
    (
        "Diagnosis of a hidden effect",
        _HIDDEN,
        "twin_with_k_T",
        "diagnosis",
        diagnosis_page.FIGURES,
        ("ranking", "effects", "next_experiments"),
    ),
    (
        "Sensitivity",
        "pyrofit sensitivity config/twin.yaml",
        "twin",
        "sensitivity",
        SENSITIVITY,
        ("total",),
    ),
    (
        "Posterior",
        "pyrofit posterior config/twin.yaml",
        "twin",
        "posterior",
        POSTERIOR,
        ("bands",),
    ),
)


def main() -> None:
    """Write the page and its figures."""
    results = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results")
    folder = DOCS / "figures" / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    page = [HEAD]
    for heading, command, study, place, figures, names in GROUPS:
        page.append(f"## {heading}\n\n    {command}\n")
        for name in names:
            source = results / study / place / f"{name}.png"
            target = folder / f"{study}_{place}_{name}.png"
            shrink(source, target)
            page.append(entry(figures[name], target, f"results/{study}/{place}/{name}.svg"))
    (DOCS / "gallery.md").write_text("\n".join(page), encoding="utf-8")


def shrink(source: Path, target: Path) -> None:
    """Write a figure with fewer pixels and colours."""
    with Image.open(source) as drawn:
        flat = drawn.convert("RGB")
        size = (min(WIDTH, flat.width), round(flat.height * min(WIDTH, flat.width) / flat.width))
        flat.resize(size, Image.Resampling.LANCZOS).quantize(COLOURS).save(target, optimize=True)


def entry(figure: Figure, target: Path, source: str) -> str:
    """Return the part of the page for one figure."""
    path = target.relative_to(DOCS).as_posix()
    return f"### {figure.title}\n\n![{figure.title}]({path})\n\n{figure.caption}\n\n`{source}`\n"


if __name__ == "__main__":
    main()
