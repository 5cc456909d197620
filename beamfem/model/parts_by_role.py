"""The public parts of the package, by the list of a model that holds them."""

from typing import Any

from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load
from beamfem.model.supports import Support
from beamfem.public_names import public_dataclasses

_BASES = {"supports": Support, "loads": Load, "joints": Joint}


def parts_in(name: str) -> list[Any]:
    """Return the classes whose objects a list of a `Model` takes: conditions and forces at points are connectors."""
    return [kind for kind in public_dataclasses("parts") if _role(kind) == name]


def _role(kind: Any) -> str:
    role = next((name for name, base in _BASES.items() if issubclass(kind, base)), None)
    return role or ("masses" if "mass" in kind.__dataclass_fields__ else "connectors")
