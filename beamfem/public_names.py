"""The public names of the package, which the stub `__init__.pyi` lists for all that deals with kinds of objects."""

import re
from dataclasses import is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

STUB = Path(__file__).with_name("__init__.pyi").read_text(encoding="utf-8")


def public(place: str) -> list[Any]:
    """Return the public classes and functions of a folder or file of the package, such as "parts", imported."""
    found = re.findall(rf"^from \.({re.escape(place)}(?:\.\w+)*) import (\w+)", STUB, re.MULTILINE)
    return [getattr(import_module(f"beamfem.{module}"), name) for module, name in found]


def public_dataclasses(place: str) -> list[Any]:
    """Return the dataclasses among the public names of a folder or file of the package."""
    return [kind for kind in public(place) if is_dataclass(kind)]
