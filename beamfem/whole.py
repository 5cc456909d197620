"""Import of the whole package, for layers below the module that imports it.

The package says at its first import which module that is, so that no layer names one above it.
"""

from importlib import import_module
from typing import Any

_modules: list[str] = []


def imports_all(module: str) -> None:
    """Say which module imports the whole package."""
    _modules[:] = [module]


def whole_package() -> Any:
    """Import the whole package and return the module that does: a second or so at the first call."""
    return import_module(*_modules)
