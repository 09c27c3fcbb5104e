"""How far a model is from its target: Eqs 1-5 and Tables 1-2 of Lauer et al.

`target` holds the measured curve, `normalisation` Table 1, `distances` Table 2. `single_point` has
Eqs 1-3 and `whole_curve` Eq. 4, with one function per cost. `gpyro` is Gpyro's objective, `kinds`
the registry, `added` the user's own costs, `weighted` Eq. 5.
"""

from pyrofit.cost.kinds import KINDS, known_costs
from pyrofit.cost.normalisation import NORMALISATIONS
from pyrofit.cost.target import FloatArray, Target
from pyrofit.cost.term import Term, check_cost_options, make_term
from pyrofit.cost.weighted import WeightedSum

__all__ = [
    "KINDS",
    "NORMALISATIONS",
    "FloatArray",
    "Target",
    "Term",
    "WeightedSum",
    "check_cost_options",
    "known_costs",
    "make_term",
]
