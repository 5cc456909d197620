"""A model: beams with their supports, joints, loads and connectors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, is_dataclass, replace
from itertools import chain, product
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.curves.curve import GAP
from beamfem.element.element import Element
from beamfem.errors import InputError, UnitsWarning, UnknownPointError, warn
from beamfem.model.beam import Beam, Point, reference_positions, require_different_names
from beamfem.model.check_units import UNNAMED, doubts_of_units
from beamfem.model.contribution import Contribution, require_connector
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import BodyLoad, CompositeLoad, LineLoad, Load, MovingLoad, PointLoad
from beamfem.model.parts_by_role import parts_in
from beamfem.model.rotating_frame import RotatingFrame
from beamfem.model.supports import LineSupport, PointSupport, Support, SupportsAlong
from beamfem.units import Units, units_of
from beamfem.validation import items, members, of_package, one_of, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamfem.mesh.beam_mesh import BeamMesh
    from beamfem.mesh.model_meshes import NodesNeeded, NumberedMeshes

Kinds = Mapping[str, tuple[type, ...]]


def listed(name: str, given: Any, kinds: Kinds) -> tuple[Any, ...]:
    """Return the parts of one of the lists of a Model; a part in its place is told to stand in brackets."""
    try:
        return tuple(items(f"{name} of Model", given))
    except InputError as error:
        if isinstance(given, kinds[name]):
            raise InputError(f"{error}; write it in brackets: {name}=[...]") from None
        raise


def refused(name: str, item: object, kinds: Kinds) -> str:
    """Return why a list of a Model cannot hold an item: where it belongs, or what it lacks."""
    said = f"{name} of a Model cannot hold {shown(item)}"
    others = [other for other, own in kinds.items() if other != name and isinstance(item, own)]
    if others:  # of several, what holds any contribution
        return f"{said}; it belongs in {'connectors' if 'connectors' in others else others[0]}"
    lacking = [member for member in members(Contribution) if not hasattr(item, member)]
    if Contribution in kinds[name] and 0 < len(lacking) < len(members(Contribution)):
        return f"{said}, which has no {' and no '.join(lacking)}, but a Contribution"
    right = [kind.__name__ for kind in ([Beam] if name == "beams" else parts_in(name))]
    right += ["another Contribution"] if Contribution in kinds[name] else []
    return f"{said}, but {' or '.join([', '.join(right[:-1]), right[-1]] if right[1:] else right)}"


def resembles_beam(beams: Sequence[Beam], beam: Beam) -> str:
    """Return in words which beam of a model is on the axis of one that is not in it, empty if none is."""
    alike = (number for number, own in enumerate(beams) if type(own.curve) is type(beam.curve))
    same = next((number for number in alike if beams[number].curve == beam.curve), None)
    if same is not None and beam.holding is not None:
        return "keep the point that body.at returned first: each call makes another one"
    return "" if same is None else f"use model.beams[{same}], a beam on the same axis"


def touching(one: Beam, other: Beam) -> str:
    """Return in words which ends of two beams are at one place, or what connects points that are apart."""
    near = GAP * max(one.curve.length, other.curve.length)
    for own, its in product(("start", "end"), repeat=2):
        if np.hypot(*(getattr(one, own).reference - getattr(other, its).reference)) <= near:
            return f"; the {own} of the first beam and the {its} of the second do"
    apart = "Weld connects points that are apart by a rigid arm, Link by a bar hinged at both"
    return f"; {apart}, SliderOnBeam one with any place along the axis of the other beam"


_KINDS: dict[str, tuple[type, ...]] = {
    "beams": (Beam,),
    "supports": (PointSupport, LineSupport),
    "loads": (BodyLoad, LineLoad, PointLoad, ImposedStrain, CompositeLoad, MovingLoad),
    "joints": (Joint, Contribution),
    "connectors": (Contribution,),
    "masses": (Contribution,),
}
_ONE = {"masses": "mass"}  # the names of one, where it is not the plural without its last letter


@dataclass(frozen=True, eq=False)
class Model:
    """Beams with supports, loads and joints, meshed and numbered.

    Supports, joints, point loads, connectors and kinks of loads along beams place a mesh node at their point. Warns
    with UnitsWarning if a Young's modulus, a density, gravity or a section cannot be meant in the units that are named.
    Raises InputError for an invalid value; UnknownPointError for a support, load, joint or connector on a beam that is
    not in the model.

    Parameters
    ----------
    beams : sequence of Beam
        The beams.
    supports : sequence, optional
        Supports, such as `Clamp` or `Foundation`.
    loads : sequence, optional
        Loads, such as `PointForce`, `Gravity` or `Temperature`.
    joints : sequence, optional
        Joints between beams: `Rigid` and `Hinge`, also `Link`, `Slider`, `Weld` and `Gear`. The distance of points that
        `Rigid` or `Hinge` joins may be up to 1e-5 of the longer beam: the second is moved to the first without stress.
    connectors : sequence of Contribution, optional
        Forces between points, such as `SpringDamper` and `Link`, or user-defined ones, see `Contribution`.
    units : str, default "N, m, s"
        Consistent units of the numbers, such as "N, mm", for labels of pictures and tables.
    masses : sequence of Contribution, optional
        Concentrated masses, `PointMass` and `RigidBody`.
    frame : RotatingFrame, optional
        Frame of reference that rotates, by default one at rest.
    redundant_conditions : {"error", "least_norm"}, default "error"
        What happens if conditions of joints and connectors depend on each other or on supports, so that their
        multipliers are not unique: an error that names them, or the multipliers of least norm, moments divided by the
        size of the model. They have to depend on each other in the reference and wherever the model moves.

    Examples
    --------
    >>> model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0.0, -1e4))])
    >>> model
    Model(1 beam, 1 support, 1 load)
    """

    beams: Sequence[Beam]
    supports: Sequence[Support] = ()
    loads: Sequence[Load] = ()
    joints: Sequence[Joint | Contribution] = ()
    connectors: Sequence[Contribution] = ()
    units: str = UNNAMED
    masses: Sequence[Contribution] = ()
    frame: RotatingFrame | None = None
    redundant_conditions: str = "error"

    def with_loads(self, loads: Sequence[Load]) -> "Model":
        """Return the model with other loads; it shares with this one whatever does not depend on loads.

        The new model has the same mesh and numbering unless a load needs a node elsewhere, and the same tables of
        solvers if the loads differ only in their size: point loads at the same points, gravity, uniform loads along
        beams. Any other load, such as a pressure or a temperature, has to be the same object. Raises InputError and
        UnknownPointError, as `Model`.

        >>> for force in (-1e3, -2e3, -3e3):
        ...     loaded = model.with_loads([bf.PointForce(beam.end, (0.0, force))])
        ...     tip = bf.solve_static(loaded).displacement(beam.end)[-1]
        """
        return self._with(loads=loads)

    def with_(
        self,
        *,
        supports: Sequence[Support] | None = None,
        loads: Sequence[Load] | None = None,
        connectors: Sequence[Contribution] | None = None,
        masses: Sequence[Contribution] | None = None,
    ) -> "Model":
        """Return the model with other supports, loads, connectors or masses; the mesh is shared if nodes are the same.

        What is not given is unchanged. Raises InputError and UnknownPointError, as `Model`, and if nothing is given.

        >>> propped = model.with_(supports=[*model.supports, bf.Roller(beam.end)])
        """
        given = {"supports": supports, "loads": loads, "connectors": connectors, "masses": masses}
        changes = {name: parts for name, parts in given.items() if parts is not None}
        if not changes:
            raise InputError(
                "with_ takes the supports, loads, connectors or masses of the new model, such as with_(loads=[...])"
            )
        return self._with(**changes)

    def _with(self, **changes: Any) -> "Model":
        model = replace(self, **changes)
        _share(self, model)
        return model

    def meshed(self, like: Any) -> "Model":
        """Return the model with the elements of a result, such as one that is refined to an accuracy.

        like: a state or solution of this model, whose beams it has with other elements; or "auto" for beams whose
        elements are chosen to an accuracy, which may be fewer than now. The new model takes the points and beams of
        both. Raises InputError for a result of another model.

        >>> finer = model.meshed(bf.solve_static(model, accuracy=1e-6))
        """
        from beamfem.solve.accuracy.error_estimate import meshed

        return meshed(self, like)

    def __getstate__(self) -> dict[str, object]:
        """Return the fields only: cached meshes refer to beams by identity, so copies rebuild theirs."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def __repr__(self) -> str:
        parts = [(name, getattr(self, name)) for name in _KINDS]
        named = [(name if len(own) > 1 else _ONE.get(name, name[:-1]), own) for name, own in parts]
        counted = [f"{len(members)} {name}" for name, members in named if members]
        return f"Model({', '.join(counted)})"

    def __post_init__(self) -> None:
        if self.units is not UNNAMED:
            _ = self._units
        for name, kinds in _KINDS.items():
            members = listed(name, getattr(self, name), _KINDS)
            object.__setattr__(self, name, members)
            for item in members:
                if not isinstance(item, kinds):
                    raise InputError(refused(name, item, _KINDS))
                kind: Any = type(item)
                own = Contribution not in kinds or isinstance(item, Joint)
                if own and not (is_dataclass(item) and kind.__dataclass_params__.frozen):
                    raise InputError(f"{kind.__name__}, one of the {name} of a Model, must be a frozen dataclass")
        self._add_arms()
        if not isinstance(self.frame, RotatingFrame | None):
            raise InputError(f"frame of a Model must be a RotatingFrame, got {shown(self.frame)}")
        one_of("redundant_conditions", self.redundant_conditions, ("error", "least_norm"))
        if not self.beams:
            raise InputError("a Model needs at least one beam")
        if len({id(beam) for beam in self.beams}) < len(self.beams):
            raise InputError("a Model lists the same beam twice; make a second Beam for a second one")
        require_different_names(self.beams)
        parts: tuple[Support | Load, ...] = (*self.supports, *self.loads)
        for part in (*parts, *self.shared_joints):
            if not of_package(type(part)):
                part.require_valid()
        for item in parts:
            self._require(item, item.place)
        for load in self.loads:
            if not isinstance(load, CompositeLoad):
                continue
            for point in load.points:
                self._require(load, point)
            if load.joint is not None and load.joint not in self.shared_joints:
                raise InputError(
                    f"{type(load).__name__} acts in a {type(load.joint).__name__} at {load.joint.a} that is not one of "
                    "the joints of the model; add it to joints"
                )
        for joint in self.shared_joints:
            self._require(joint, joint.a)
            self._require(joint, joint.b)
        for connector in self.at_points:
            require_connector(connector)
            for point in connector.points:
                self._require(connector, point)
        self._require_touches()
        for doubt in doubts_of_units(self.beams, self.loads, self.units):
            warn(doubt, UnitsWarning)

    def _add_arms(self) -> None:
        """Add the arms of bodies on which parts act, with the joints that hold them. Raises InputError."""
        parts = (*self.supports, *self.loads, *self.joints, *self.connectors, *self.masses)
        places = [getattr(part, name, None) for part in parts for name in ("place", "a", "b")]
        several = [getattr(part, "points", ()) for part in parts]
        places += [point for points in several if isinstance(points, tuple | list) for point in points]
        points = [place for place in places if isinstance(place, Point)]
        for point in points:
            point.beam.require_place(point.fraction, parts)
        held = {point.beam: point.beam.holding for point in points}
        arms = {beam: joints for beam, joints in held.items() if joints is not None and id(beam) not in self._numbers}
        if arms:
            del vars(self)["_numbers"]
            object.__setattr__(self, "beams", (*self.beams, *arms))
            object.__setattr__(self, "joints", (*self.joints, *chain(*arms.values())))

    def _require(self, item: object, place: Beam | Point | None) -> None:
        kind = type(item).__name__
        beam = place.beam if isinstance(place, Point) else place
        if beam is not None and id(beam) not in self._numbers:
            where = f" at {place}" if isinstance(place, Point) else ""
            raise self._unknown(f"{kind}{where} is on a beam that", beam, "add it to beams")

    def _require_touches(self) -> None:
        """Raise InputError for the first joint whose points do not coincide."""
        joints = self.shared_joints
        if not joints:
            return
        ends = (reference_positions([getattr(joint, name) for joint in joints]) for name in "ab")
        gaps = np.linalg.norm(np.subtract(*ends), axis=1).tolist()
        for joint, gap in zip(joints, gaps, strict=True):
            kind, a, b = type(joint).__name__, joint.a, joint.b
            if a.beam is b.beam and a.fraction == b.fraction:
                raise InputError(f"{kind} joins the point {a} with itself")
            if gap > GAP * max(a.beam.curve.length, b.beam.curve.length):
                raise InputError(
                    f"{kind} joins {a} and {b}, which are {gap:g} {self.unit('m')} apart; a joint needs points that "
                    f"coincide, to {GAP:g} of the longer beam{touching(a.beam, b.beam)}"
                )

    @cached_property
    def _units(self) -> Units:
        return units_of(self.units)

    def unit(self, unit: str) -> str:
        """Return the model's unit for an SI unit such as "Pa", "N m" or "kg".

        A name that is no SI unit is returned as it is.

        >>> steel = bf.Material(2e5, 0.3, 7.8e-9)
        >>> strip = bf.Beam(bf.Line((0, 0), (500, 0)), 4, bf.CRBF(3), bf.Rectangle(20, 4), steel)
        >>> bf.Model([strip], units="N, mm").unit("Pa")
        'MPa'
        """
        return self._units.of(unit)

    @cached_property
    def _numbers(self) -> dict[int, int]:
        return {id(beam): number for number, beam in enumerate(self.beams)}

    @cached_property
    def numbered(self) -> "NumberedMeshes":
        """The meshes of the beams with the numbers of their coordinates."""

        from beamfem.mesh.model_meshes import numbered_meshes

        return numbered_meshes(self)

    @cached_property
    def nodes_needed(self) -> "NodesNeeded":
        """The nodes that supports, loads and connectors need."""

        from beamfem.mesh.model_meshes import nodes_needed

        return nodes_needed(self)

    @cached_property
    def tables(self) -> dict[Any, Any]:
        """Tables of solvers, by name, in common with the models that `with_loads` has made from this one."""
        return {}

    @property
    def meshes(self) -> "tuple[BeamMesh, ...]":
        """The mesh of each beam, in the order of the beams."""
        return self.numbered.meshes

    @cached_property
    def automatic(self) -> bool:
        """Whether the mesh of a beam is left to the analyses, see `Beam`."""
        return any(beam.elements == "auto" for beam in self.beams)

    @property
    def coordinates(self) -> int:
        """Number of coordinates of the beams, including prescribed ones; shared ones are counted once."""
        return self.numbered.coordinates

    @property
    def size(self) -> int:
        """Number of all variables: coordinates of the beams, unknowns of connectors, and history variables."""
        return self.numbered.size

    @property
    def mass(self) -> float:
        """Mass [kg] of the beams and of the concentrated masses.

        >>> round(bf.Model([beam], masses=[bf.PointMass(beam.end, mass=5.0)]).mass, 3)
        83.5
        """
        from beamfem.mesh.reference import inertia_points

        own = sum(float(inertia_points(mesh)[2][:, 0].sum()) for mesh in self.meshes)
        return own + sum(float(getattr(part, "mass", 0.0)) for part in self.masses)

    @property
    def groups(self) -> tuple[Element, ...]:
        """The element of each block of beams, in order of appearance; different section laws form separate blocks."""
        return self.numbered.groups

    def number_of(self, beam: Beam) -> int:
        """Return the number of a beam, counted from 0.

        Raises InputError for anything but a beam, UnknownPointError for a beam that is not in the model.
        """
        if not isinstance(beam, Beam):
            raise InputError(f"a beam is asked for, one of the model's beams, got {shown(beam)}")
        if id(beam) not in self._numbers:
            raise self._unknown(f"the beam {beam!r}", beam)
        return self._numbers[id(beam)]

    def _unknown(self, what: str, beam: Beam, *remedy: str) -> UnknownPointError:
        remedies = ", or ".join(filter(None, (*remedy, resembles_beam(self.beams, beam))))
        return UnknownPointError("; ".join(filter(None, (f"{what} is not in this model", remedies))))

    def mesh_of(self, point: Point) -> "BeamMesh":
        """Return the mesh that a point lies on, which is that of its beam.

        Raises InputError for anything but a point, UnknownPointError for a point on a beam that is not in the model.
        """
        if not isinstance(point, Point):
            raise InputError(f"a point is asked for, such as beam.end or beam.at(0.5), got {shown(point)}")
        if id(point.beam) not in self._numbers:
            raise self._unknown(f"the point {point} is on a beam that", point.beam)
        return self.meshes[self._numbers[id(point.beam)]]

    @cached_property
    def shared_joints(self) -> tuple[Joint, ...]:
        """The joints at which beams share coordinates."""
        return tuple(joint for joint in self.joints if isinstance(joint, Joint))

    @cached_property
    def at_points(self) -> tuple[Contribution, ...]:
        """Connectors, masses, joints that are conditions, and conditions of loads: what acts on points."""
        conditions = (joint for joint in self.joints if not isinstance(joint, Joint))
        of_loads = (part for part in self._parts_of_loads if not isinstance(part, Load | Support))
        return (*self.connectors, *self.masses, *conditions, *of_loads)

    @cached_property
    def _parts_of_loads(self) -> tuple[Any, ...]:
        return tuple(part for load in self.loads for part in load.parts)

    def name_of(self, part: object) -> str:
        """Return the name of the kind of a part for messages, that of the load if a load consists of it."""
        return type(self._loads_of_parts.get(id(part), part)).__name__

    @cached_property
    def _loads_of_parts(self) -> dict[int, Load]:
        return {id(part): load for load in self.loads for part in load.parts}

    @cached_property
    def acting(self) -> tuple[Load, ...]:
        """The loads, compound ones replaced by their parts; loads that no table depends on come last."""
        return tuple(
            sorted((part for part in self._parts_of_loads if isinstance(part, Load)), key=lambda load: load.even)
        )

    @cached_property
    def imposing(self) -> tuple[tuple[int, ImposedStrain], ...]:
        """The loads that impose strains, each with the number of its beam."""
        return tuple((self._numbers[id(load.beam)], load) for load in self.loads if isinstance(load, ImposedStrain))

    @cached_property
    def imposed_on(self) -> dict[Beam, list[tuple[int, ImposedStrain]]]:
        """The loads that impose strains on each beam, with their numbers in `imposing`."""
        result: dict[Beam, list[tuple[int, ImposedStrain]]] = {}
        for number, (beam, load) in enumerate(self.imposing):
            result.setdefault(self.beams[beam], []).append((number, load))
        return result

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
        return tuple(part for part in self._parts_of_loads if isinstance(part, PointLoad))

    @cached_property
    def point_supports(self) -> tuple[PointSupport, ...]:
        """The supports at points."""
        parts = (*self.supports, *self._parts_of_loads)
        return tuple(part for part in parts if isinstance(part, PointSupport))

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

        modes: result of `solve_buckling` or `solve_modes`, or an increment (n,) of all coordinates; size [m]: largest
        displacement; mode: index of the mode. Raises InputError if the modes do not fit the model or move no axis.

        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
        >>> crooked = column.with_imperfection(bf.solve_buckling(column), size=0.002)
        """
        from beamfem.results.imperfection import with_imperfection

        return with_imperfection(self, modes, size, mode)

    def plot(self, path: str | PathLike[str] | None = None, *, ax: Any = None) -> "Figure":
        """Draw the undeformed model with its supports and loads and return the figure.

        Nothing is solved, so mechanisms and overloaded models can be drawn too. path: file to write (PNG, SVG, PDF);
        ax: axes to draw in, see `Solution.plot`. Raises MissingPackageError without matplotlib.
        """
        from beamfem.view.drawing import plot_model

        return plot_model(self, path, ax)

    def _repr_html_(self) -> str:
        from beamfem.view.summary import model_table

        return model_table(self)


def _share(old: Model, new: Model) -> None:
    """Give a new model the meshes of an old one if their nodes are the same, and its tables if sizes of loads differ.

    Both have the same beams and joints, unless the new one has more arms of rigid bodies.
    """
    if len(old.beams) != len(new.beams):
        return
    same = all(map(_same, (old.supports, old.at_points, _layouts(old)), (new.supports, new.at_points, _layouts(new))))
    if same or old.nodes_needed == new.nodes_needed:
        vars(new)["numbered"] = old.numbered
    # the stiffness of a connector may depend on gravity
    if same and (not new.at_points or _same(old.gravity, new.gravity)):
        vars(new)["tables"] = old.tables


def _layouts(model: Model) -> list[Any]:
    """Return the loads of a model without their sizes, see `Load.layout`."""
    layouts = (load.layout for load in model.loads)
    return [layout for layout in layouts if layout is not None]


def _same(one: Any, other: Any) -> bool:
    """Return whether two sequences hold the same objects, or equal points and flags of loads."""
    return len(one) == len(other) and all(
        a is b or (type(a) is tuple and a == b) for a, b in zip(one, other, strict=True)
    )
