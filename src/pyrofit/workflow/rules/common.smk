"""What several files of rules share."""

from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results.step import exists, inputs_of, slice_of
from pyrofit.show.names import titled
from pyrofit.steps import known_steps


def log_of(name):
    return str(ROOT / "logs" / f"{name}.log")


def benchmark_of(name):
    return str(ROOT / "benchmarks" / f"{name}.tsv")


def identification(stage, *more):
    """Return what is found of a stage's parameters."""
    tables = ("estimate", "sensitivities", "singular_values", "correlation", "profiles")
    names = [
        *(f"{name}.csv" for name in (*tables, *more)),
        "noise.json",
        "goodness.json",
    ]
    return [results.identification(name, stage) for name in names]


def title_in(shown, name):
    """Return the title of a table or figure in this study."""
    return titled(study, shown[name].title, shown[name].paper)


def reported(path, kind, titles, name):
    """Return a file that Snakemake's own report shows as well."""
    return report(
        path,
        caption="../report/subject.rst",
        category=f"{kind.capitalize()}s",
        labels={kind: title_in(titles, name)},
    )


# The ends of the optimisers beside SCE-UA.
STARTED = expand(
    ROOT / "imp/{cost}/{optimiser}.json", cost=COSTS, optimiser=list(OPTIMISERS)
)

# Their ends and SCE-UA's best sets: signals that jump have their noise about the best of them.
JUMPS = any(study.experiments[c.experiment].jumps for c in study.imp.channels)
FITS_FOR_NOISE = [results.imp("summary.csv"), STARTED] if JUMPS else []


def repetitions_in(files):
    """Return the repetitions whose results are among some files."""
    return [Path(name).stem for name in files if name.endswith(".json")]


# Of steps whose parts are not repeated unless asked for, what the pages show.
VERSIONS = {
    name: inputs.version(study, results)
    for name in known_steps()
    if (inputs := inputs_of(name)).version
}
