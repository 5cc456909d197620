"""The parts that the package lists, by what they are in a model."""

from typing import Any

from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load
from beamfem.model.supports import Support
from beamfem.parts import listed_parts as parts
from beamfem.parts.point_mass import PointMass
from beamfem.parts.rigid_body import RigidBody

BASES: dict[str, Any] = {"supports": Support, "loads": Load, "joints": Joint, "masses": (PointMass, RigidBody)}
_ALL = (Support, Load, Joint, PointMass, RigidBody)


def listed_parts() -> tuple[Any, ...]:
    """Return all classes that are listed in `beamfem.parts.listed_parts`."""
    return tuple(kind for kind in vars(parts).values() if isinstance(kind, type))


def parts_in(name: str) -> tuple[Any, ...]:
    """Return the classes whose objects a list of a `Model` takes; connectors derive from none of the base classes."""
    if name in BASES:
        return tuple(kind for kind in listed_parts() if issubclass(kind, BASES[name]))
    return tuple(kind for kind in listed_parts() if not issubclass(kind, _ALL))
