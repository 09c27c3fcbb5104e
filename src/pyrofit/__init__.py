"""Inverse modelling of pyrolysis: from measurements of a solid to the parameters of its model.

`__all__` lists the stable names of the Python interface; each is imported when it is first used.
Packages beside pyrofit add names by entry points of the group ``pyrofit.interface``.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

__version__ = "0.2.0"

_HOMES = {
    "Campaign": "api.results",
    "Comparison": "api.comparison",
    "Curves": "api.curves",
    "Diagnosis": "api.diagnosing",
    "Ensemble": "api.ensemble",
    "Fit": "api.fitted",
    "Isoconversional": "api.isoconversional",
    "PyrofitError": "errors",
    "Study": "config",
    "compare": "api.comparison",
    "compare_models": "api.models",
    "diagnose": "api.diagnosing",
    "effects": "api.catalogue",
    "fit": "api.fitting",
    "isoconversional": "api.isoconversional",
    "log_likelihood": "api.objectives",
    "new_study": "api.drafting",
    "read_data": "api.measurements",
    "read_results": "api.results",
    "read_study": "api.studies",
    "residuals": "api.objectives",
    "simulate": "api.simulation",
    "write_study": "api.saving",
}


class _Package(ModuleType):
    """The package, in which some functions have the names of modules and stand before them.

    The import of a module sets it as an attribute of its package; `from pyrofit.effects import x`
    does not need that attribute.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in _HOMES and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> Any:
    """Import a name of the interface when it is first used."""
    if name == "__all__":
        return __dir__()
    if name in _HOMES:
        found = getattr(import_module(f"pyrofit.{_HOMES[name]}"), name)
    elif name not in _added():
        raise AttributeError(f"module 'pyrofit' has no attribute '{name}'")
    else:
        found = import_module("pyrofit.discovery").loaded(_added()[name])
    globals()[name] = found
    return found


def _added() -> dict[str, Any]:
    """Return the entry points of names that other packages add."""
    points: dict[str, Any] = import_module("pyrofit.discovery").added("interface")
    return points


def __dir__() -> list[str]:
    """List the names of the interface."""
    return sorted({"__version__", *_HOMES, *_added()})
