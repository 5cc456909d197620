"""A model: beams with their supports, joints, loads and connectors."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, is_dataclass
from os import PathLike
from typing import Any

import numpy as np

from beamfem.alike import by_value, of_package
from beamfem.curves.curve import GAP
from beamfem.element.element import Element
from beamfem.errors import InputError, UnknownPointError
from beamfem.model.beam import Beam, Point, reference_positions
from beamfem.model.body_load import BodyLoad
from beamfem.model.contribution import Contribution, require_connector
from beamfem.model.imposed_strain import ImposedStrain
from beamfem.model.joints import Joint
from beamfem.model.likeness import shared_by_likes
from beamfem.model.line_load import LineLoad
from beamfem.model.load import Load
from beamfem.model.made_of import MadeOf, made_of
from beamfem.model.mesh import BeamMesh
from beamfem.model.meshes import NumberedMeshes, numbered_meshes
from beamfem.model.misplaced import beam_like, listed, refused, touching
from beamfem.model.named import require_different_names
from beamfem.model.plausible import warn_of_units
from beamfem.model.point_load import PointLoad
from beamfem.model.support import LineSupport, PointSupport, Support
from beamfem.model.supports_along import SupportsAlong
from beamfem.once import cached_property, shared_property
from beamfem.units import Units, units_of
from beamfem.validation import shown

_UNNAMED = "N, m, s"
_KINDS: dict[str, tuple[type, ...]] = {
    "beams": (Beam,),
    "supports": (PointSupport, LineSupport),
    "loads": (BodyLoad, LineLoad, PointLoad, ImposedStrain),
    "joints": (Joint,),
    "connectors": (Contribution,),
}


@dataclass(frozen=True, eq=False)
class Model:
    """Beams with supports, loads and joints, meshed and numbered.

    Supports, joints, point loads, connectors and kinks of loads along beams place a mesh node at their point.

    Parameters
    ----------
    beams : sequence of Beam
        The beams.
    supports : sequence, optional
        Supports, such as `Clamp` or `Foundation`.
    loads : sequence, optional
        Loads, such as `PointForce`, `Gravity` or `Temperature`.
    joints : sequence of Joint, optional
        Joints between beams. The distance of joined points may be up to 1e-5 of the longer beam: the second is moved to
        the first without stress.
    connectors : sequence of Contribution, optional
        User-defined forces between points, see `Contribution`.
    units : str, default "N, m, s"
        Consistent units of the numbers, such as "N, mm", for labels of pictures and tables.

    Raises
    ------
    InputError
        For an invalid value.
    UnknownPointError
        For a support, load, joint or connector on a beam that is not in the model.

    Warns
    -----
    UnitsWarning
        If a Young's modulus, a density, gravity or a section cannot be meant in the units that are named.

    Examples
    --------
    >>> model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0.0, -1e4))])
    >>> model
    Model(1 beam, 1 support, 1 load)
    """

    beams: Sequence[Beam]
    supports: Sequence[Support] = ()
    loads: Sequence[Load] = ()
    joints: Sequence[Joint] = ()
    connectors: Sequence[Contribution] = ()
    units: str = _UNNAMED

    def __getstate__(self) -> dict[str, object]:
        """Return the fields only: cached meshes refer to beams by identity, so copies rebuild theirs."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def __repr__(self) -> str:
        parts = [(name[:-1], getattr(self, name)) for name in _KINDS]
        counted = [f"{len(members)} {name}{'' if len(members) == 1 else 's'}" for name, members in parts if members]
        return f"Model({', '.join(counted)})"

    def __post_init__(self) -> None:
        _ = self._units
        for name, kinds in _KINDS.items():
            members = listed(name, getattr(self, name), _KINDS)
            object.__setattr__(self, name, members)
            for item in members:
                if not isinstance(item, kinds):
                    raise InputError(refused(name, item, _KINDS))
                kind: Any = type(item)
                if name != "connectors" and not (is_dataclass(item) and kind.__dataclass_params__.frozen):
                    raise InputError(f"{kind.__name__}, one of the {name} of a Model, must be a frozen dataclass")
        if not self.beams:
            raise InputError("a Model needs at least one beam")
        if len({id(beam) for beam in self.beams}) < len(self.beams):
            raise InputError("a Model lists the same beam twice; make a second Beam for a second one")
        require_different_names(self.beams)
        parts: tuple[Support | Load, ...] = (*self.supports, *self.loads)
        for part in (*parts, *self.joints):
            part_kind: Any = type(part)
            if not of_package(part_kind):
                part.require_valid()
        for item in parts:
            self._require(item, item.place)
        for joint in self.joints:
            self._require(joint, joint.a)
            self._require(joint, joint.b)
        for connector in self.connectors:
            require_connector(connector)
            for point in connector.points:
                self._require(connector, point)
        self._require_touches()
        if self.units != _UNNAMED:
            warn_of_units(self.beams, self.loads, self.units, self._units)

    def _require(self, item: object, place: Beam | Point | None) -> None:
        kind = type(item).__name__
        beam = place.beam if isinstance(place, Point) else place
        if beam is not None and id(beam) not in self._numbers:
            where = f" at {place}" if isinstance(place, Point) else ""
            remedy = ", or ".join(filter(None, ("add it to beams", beam_like(self.beams, beam))))
            raise UnknownPointError(f"{kind}{where} is on a beam that is not in this model; {remedy}")

    def _require_touches(self) -> None:
        """Raise InputError for the first joint whose points do not coincide."""
        if not self.joints:
            return
        a, b = (reference_positions([getattr(joint, name) for joint in self.joints]) for name in "ab")
        gaps = np.linalg.norm(a - b, axis=1).tolist()
        for joint, gap in zip(self.joints, gaps, strict=True):
            self._require_touch(joint, gap)

    def _require_touch(self, joint: Joint, gap: float) -> None:
        kind = type(joint).__name__
        if joint.a.beam is joint.b.beam and joint.a.fraction == joint.b.fraction:
            raise InputError(f"{kind} joins the point {joint.a} with itself")
        if gap > GAP * max(joint.a.beam.curve.length, joint.b.beam.curve.length):
            raise InputError(
                f"{kind} joins {joint.a} and {joint.b}, which are {gap:g} {self.unit('m')} apart; a joint needs points "
                f"that coincide, to {GAP:g} of the longer beam{touching(joint.a.beam, joint.b.beam)}"
            )

    @cached_property
    def _units(self) -> Units:
        return units_of(self.units)

    def unit(self, unit: str) -> str:
        """Return the model's unit for an SI unit such as "Pa", "N m" or "kg".

        A name that is no SI unit is returned as it is.

        Examples
        --------
        >>> steel = bf.Material(2e5, 0.3, 7.8e-9)
        >>> strip = bf.Beam(bf.Line((0, 0), (500, 0)), 4, bf.CRBF(3), bf.Rectangle(20, 4), steel)
        >>> bf.Model([strip], units="N, mm").unit("Pa")
        'MPa'
        """
        return self._units.of(unit)

    @cached_property
    def alike(self) -> dict[Any, Any]:
        """What this model and all models that are like it but for the size of loads have in common, by name."""
        return shared_by_likes(self)

    @shared_property
    def made_of(self) -> MadeOf:
        """What the meshes were made of and may change, see `made_of`."""
        return made_of(self)

    @cached_property
    def _numbers(self) -> dict[int, int]:
        return {id(beam): number for number, beam in enumerate(self.beams)}

    @cached_property
    def _numbered(self) -> NumberedMeshes:
        shared = self._numbered_alike
        pairs = tuple(zip(shared.meshes, self.beams, strict=True))
        if all(mesh.beam is beam for mesh, beam in pairs):  # models may have some of their beams in common
            return shared
        meshes = tuple(mesh.on(beam) for mesh, beam in pairs)
        return shared._replace(meshes=meshes)

    @shared_property
    def _numbered_alike(self) -> NumberedMeshes:
        """The meshes of the first of the models that are alike."""
        _ = self.made_of
        return numbered_meshes(self)

    @property
    def meshes(self) -> tuple[BeamMesh, ...]:
        """The mesh of each beam, in the order of the beams."""
        return self._numbered.meshes

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the beams, including prescribed ones; shared ones are counted once."""
        return self._numbered.coordinates

    @property
    def size(self) -> int:
        """Number of all variables: coordinates of the beams, unknowns of connectors, and history variables."""
        return self._numbered.size

    @shared_property
    def groups(self) -> tuple[Element, ...]:
        """The element of each block of beams, in order of appearance; different section laws form separate blocks."""
        return tuple(element for element, *_ in self._kinds[0])

    @property
    def blocks_of_beams(self) -> tuple[int, ...]:
        """The number of the block of each beam."""
        return self._kinds[1]

    @shared_property
    def _kinds(self) -> tuple[tuple[tuple[Element, Hashable], ...], tuple[int, ...]]:
        """The key of each block of beams, and the number of the block of each beam."""
        blocks: dict[tuple[Element, Hashable], int] = {}
        numbers = tuple(blocks.setdefault(block_key(beam), len(blocks)) for beam in self.beams)
        return tuple(blocks), numbers

    def number_of(self, beam: Beam) -> int:
        """Return the number of a beam, counted from 0.

        Raises InputError for anything but a beam, UnknownPointError for a beam that is not in the model.

        Examples
        --------
        >>> model.number_of(beam)
        0
        """
        if not isinstance(beam, Beam):
            raise InputError(f"a beam is asked for, one of the model's beams, got {shown(beam)}")
        if id(beam) not in self._numbers:
            raise self._unknown(f"the beam {beam!r} is not in this model", beam)
        return self._numbers[id(beam)]

    def _unknown(self, message: str, beam: Beam) -> UnknownPointError:
        return UnknownPointError("; ".join(filter(None, (message, beam_like(self.beams, beam)))))

    def mesh_of(self, point: Point) -> BeamMesh:
        """Return the mesh that a point lies on, which is that of its beam.

        Raises InputError for anything but a point, UnknownPointError for a point on a beam that is not in the model.

        Examples
        --------
        >>> model.mesh_of(beam.end).elements
        4
        """
        if not isinstance(point, Point):
            raise InputError(f"a point is asked for, such as beam.end or beam.at(0.5), got {shown(point)}")
        if id(point.beam) not in self._numbers:
            raise self._unknown(f"the point {point} is on a beam that is not in this model", point.beam)
        return self.meshes[self._numbers[id(point.beam)]]

    @cached_property
    def imposing(self) -> tuple[tuple[int, ImposedStrain], ...]:
        """The loads that impose strains, each with the number of its beam."""
        return tuple((self._numbers[id(load.beam)], load) for load in self.loads if isinstance(load, ImposedStrain))

    @cached_property
    def gravity(self) -> tuple[BodyLoad, ...]:
        """The loads that are accelerations of all mass."""
        return tuple(load for load in self.loads if isinstance(load, BodyLoad))

    @cached_property
    def line_loads(self) -> tuple[LineLoad, ...]:
        """The loads that are forces along beams."""
        return tuple(load for load in self.loads if isinstance(load, LineLoad))

    @cached_property
    def point_loads(self) -> tuple[PointLoad, ...]:
        """The loads that are forces and moments at points."""
        return tuple(load for load in self.loads if isinstance(load, PointLoad))

    @cached_property
    def point_supports(self) -> tuple[PointSupport, ...]:
        """The supports at points."""
        return tuple(support for support in self.supports if isinstance(support, PointSupport))

    @cached_property
    def supports_along(self) -> SupportsAlong:
        """The supports at points in the order of their beams' fractions."""
        return SupportsAlong(self.point_supports)

    @cached_property
    def line_supports(self) -> tuple[LineSupport, ...]:
        """The supports along beams."""
        return tuple(support for support in self.supports if isinstance(support, LineSupport))

    def with_imperfection(self, modes: Any, size: float, mode: int = 0) -> "Model":
        """Return the model with its axes displaced by a mode and stress-free in the new shape.

        Raises InputError if the modes do not fit the model or move no axis.

        Parameters
        ----------
        modes : Buckling, Modes or array
            Result of `solve_buckling` or `solve_modes`, or an increment (n,) of all coordinates.
        size : float, [m]
            Largest displacement.
        mode : int, default 0
            Index of the mode.

        Examples
        --------
        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
        >>> crooked = column.with_imperfection(bf.solve_buckling(column), size=0.002)
        """
        from beamfem.results.imperfection import with_imperfection

        return with_imperfection(self, modes, size, mode)

    def plot(self, path: str | PathLike[str] | None = None) -> Any:
        """Draw the undeformed model with its supports and loads and return the figure.

        Nothing is solved, so mechanisms and overloaded models can be drawn too. path: file to write (PNG, SVG, PDF).
        Raises MissingPackageError without matplotlib.

        Examples
        --------
        >>> figure = model.plot("model.png")
        """
        from beamfem.view.model_drawing import plot_model

        return plot_model(self, path)

    def _repr_html_(self) -> str:
        from beamfem.view.summary import model_table

        return model_table(self)


def block_key(beam: Beam) -> tuple[Element, Hashable]:
    """Return the key that beams of one block share."""
    law = beam.law
    return beam.element, None if law is None else (by_value(law.section), by_value(law.material))
