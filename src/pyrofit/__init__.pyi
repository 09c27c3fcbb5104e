from pyrofit.api.catalogue import effects as effects
from pyrofit.api.comparison import Comparison as Comparison
from pyrofit.api.comparison import compare as compare
from pyrofit.api.curves import Curves as Curves
from pyrofit.api.diagnosing import Diagnosis as Diagnosis
from pyrofit.api.diagnosing import diagnose as diagnose
from pyrofit.api.drafting import new_study as new_study
from pyrofit.api.ensemble import Ensemble as Ensemble
from pyrofit.api.fitted import Fit as Fit
from pyrofit.api.fitting import fit as fit
from pyrofit.api.isoconversional import Isoconversional as Isoconversional
from pyrofit.api.isoconversional import isoconversional as isoconversional
from pyrofit.api.measurements import read_data as read_data
from pyrofit.api.models import compare_models as compare_models
from pyrofit.api.objectives import log_likelihood as log_likelihood
from pyrofit.api.objectives import residuals as residuals
from pyrofit.api.results import Campaign as Campaign
from pyrofit.api.results import read_results as read_results
from pyrofit.api.saving import write_study as write_study
from pyrofit.api.simulation import simulate as simulate
from pyrofit.api.studies import read_study as read_study
from pyrofit.config import Study as Study
from pyrofit.errors import PyrofitError as PyrofitError
from pyrofit_compare.against import compare_with as compare_with
from pyrofit_explore.run import explore as explore
from pyrofit_files.look import Look as Look
from pyrofit_files.look import look as look

__version__: str
__all__ = [
    "Campaign",
    "Comparison",
    "Curves",
    "Diagnosis",
    "Ensemble",
    "Fit",
    "Isoconversional",
    "Look",
    "PyrofitError",
    "Study",
    "__version__",
    "compare",
    "compare_models",
    "compare_with",
    "diagnose",
    "effects",
    "explore",
    "fit",
    "isoconversional",
    "log_likelihood",
    "look",
    "new_study",
    "read_data",
    "read_results",
    "read_study",
    "residuals",
    "simulate",
    "write_study",
]
