"""A model: beams, what holds them and what acts on them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from beamfem.errors import InputError, UnknownPointError
from beamfem.model.beam import Beam, Point
from beamfem.model.loads import DistributedLoad, Gravity, Load, PointForce, PointMoment
from beamfem.model.mesh import BeamMesh, vertices_with
from beamfem.model.supports import Clamp, Pin, Prescribed, Roller, Support


@dataclass(frozen=True, eq=False)
class Model:
    """Beams with supports and loads, meshed and numbered.

    Supports put a mesh node at their point; loads act anywhere. Raises InputError, UnknownPointError.
    """

    beams: Sequence[Beam]
    supports: Sequence[Support] = ()
    loads: Sequence[Load] = ()

    def __post_init__(self) -> None:
        for name in ("beams", "supports", "loads"):
            if not isinstance(getattr(self, name), Sequence):
                raise InputError(f"{name} of a Model must be a list, got {getattr(self, name)!r}")
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if not self.beams:
            raise InputError("a Model needs at least one beam")
        for name, kinds in (("beams", Beam), ("supports", Support), ("loads", Load)):
            for item in getattr(self, name):
                if not isinstance(item, kinds):
                    raise InputError(f"{name} of a Model cannot hold {item!r}")
        if len({id(beam) for beam in self.beams}) < len(self.beams):
            raise InputError("a Model lists the same beam twice; make a second Beam for a second one")
        for item in (*self.supports, *self.loads):
            for place, kind in (("point", Point), ("beam", Beam)):
                if not isinstance(getattr(item, place, None), kind | None):
                    what = f"{place} of {type(item).__name__} must be a {kind.__name__}"
                    raise InputError(f"{what} such as beam.end or beam, got {getattr(item, place)!r}")
            if isinstance(item, Clamp | Pin | Roller | Prescribed | PointForce | PointMoment):
                self._require(item.point.beam, type(item).__name__, f" at {item.point}")
            elif isinstance(item, DistributedLoad):
                self._require(item.beam, "DistributedLoad", "")

    def _require(self, beam: Beam, what: str, where: str) -> None:
        if not any(beam is own for own in self.beams):
            raise UnknownPointError(f"{what}{where} is on a beam that is not in this model; add it to beams")

    @cached_property
    def meshes(self) -> tuple[BeamMesh, ...]:
        """One mesh a beam, numbered in the order of the beams."""
        groups = self.groups
        filled = [0] * len(groups)
        first_dof = 0
        meshes = []
        for beam in self.beams:
            fractions = [s.point.fraction for s in self.supports if s.point.beam is beam]
            block = groups.index(beam.element)
            mesh = BeamMesh(beam, vertices_with(beam, fractions), first_dof, filled[block], block)
            first_dof += mesh.size
            filled[block] += mesh.elements
            meshes.append(mesh)
        return tuple(meshes)

    @cached_property
    def groups(self) -> tuple:
        """The different elements of the beams, in order of appearance."""
        return tuple(dict.fromkeys(beam.element for beam in self.beams))

    @property
    def size(self) -> int:
        """Number of coordinates, held ones included."""
        return sum(mesh.size for mesh in self.meshes)

    def mesh_of(self, point: Point) -> BeamMesh:
        """Return the mesh that a point lies on. Raises UnknownPointError."""
        for mesh in self.meshes:
            if mesh.beam is point.beam:
                return mesh
        raise UnknownPointError(f"the point {point} is on a beam that is not in this model")

    @property
    def gravity(self) -> tuple[Gravity, ...]:
        return tuple(load for load in self.loads if isinstance(load, Gravity))

    @property
    def distributed(self) -> tuple[DistributedLoad, ...]:
        return tuple(load for load in self.loads if isinstance(load, DistributedLoad))

    @property
    def point_loads(self) -> tuple[PointForce | PointMoment, ...]:
        return tuple(load for load in self.loads if isinstance(load, PointForce | PointMoment))
