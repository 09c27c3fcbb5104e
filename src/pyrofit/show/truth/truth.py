"""Truth beside estimate."""

from pyrofit.analysis.recovery import known, truth
from pyrofit.show.table import Table

TABLE = Table(
    place=10,
    applies=lambda study: bool(known(study)),
    make=truth,
    title="Truth and the best sets",
    note="Errors are estimate minus truth, in per cent of the truth and of the distance "
    "between the limits. An inverse modelling with fitted kinetics takes those of the "
    "optimiser with the lower cost.",
    headings={
        "sceua_best": "SCE-UA best",
        "sceua_error_truth_percent": "SCE-UA error [% of truth]",
        "sceua_error_limits_percent": "SCE-UA error [% of limits]",
        "least_squares_best": "least squares best",
        "least_squares_error_truth_percent": "least squares error [% of truth]",
        "least_squares_error_limits_percent": "least squares error [% of limits]",
        "cmaes_best": "CMA-ES best",
        "cmaes_error_truth_percent": "CMA-ES error [% of truth]",
        "cmaes_error_limits_percent": "CMA-ES error [% of limits]",
    },
    group_by="fit",
)
