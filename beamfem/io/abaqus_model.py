"""Planar models of beams and trusses in Abaqus input files, which CalculiX reads too: what a `Model` is made of.

Source: Abaqus keywords reference and analysis guide (beam section library, default shear coefficients, loads of beams).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.element.element import CRBF, Element
from beamfem.errors import InputError, NotReadWarning, warn
from beamfem.io.frame import Frame, build_frame
from beamfem.io.line_mesh import LineMesh, line_mesh
from beamfem.io.mesh_files import OF_THE_MESH, Keyword, MeshFile, content_of, keywords_of, listed, number
from beamfem.material import Material
from beamfem.model.beam import Point
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.model.supports import PointSupport
from beamfem.parts.clamp import Clamp
from beamfem.parts.distributed_load import DistributedLoad
from beamfem.parts.gravity import Gravity
from beamfem.parts.hinge import Hinge
from beamfem.parts.pin import Pin
from beamfem.parts.point_force import PointForce
from beamfem.parts.point_moment import PointMoment
from beamfem.parts.prescribed import Prescribed
from beamfem.parts.pressure import Pressure
from beamfem.parts.rigid import Rigid
from beamfem.reprs import brief
from beamfem.section import Circle, Polygon, Rectangle, Section, StiffnessSection, Tube

_PLANES = ((0, 1, 2), (0, 2, 1), (1, 2, 0))  # axes of the file that are x, y and z here
_SYMMETRIES = {"ENCASTRE": range(1, 7), "PINNED": (1, 2, 3), "XSYMM": (1, 5, 6), "YSYMM": (2, 4, 6), "ZSYMM": (3, 4, 5)}
_OF_MATERIAL = {"DENSITY": ("density",), "EXPANSION": ("thermal_expansion",), "PLASTIC": ("strength",)}
_PRINTED = {"OUTPUT", "NODE OUTPUT", "ELEMENT OUTPUT", "ENERGY OUTPUT", "NODE PRINT", "EL PRINT", "NODE FILE"}
_PRINTED |= {"EL FILE", "RESTART", "FILE FORMAT", "MONITOR", "CONTROLS", "SOLVER CONTROLS", "PHYSICAL CONSTANTS"}
_TRUSSES = "trusses of the file"
_JOINED = "ends of trusses of the file"
# the shear coefficients that Abaqus takes by default
_SHAPES: dict[str, tuple[int, Callable[..., Section]]] = {
    "RECT": (2, lambda a, b: Rectangle(a, b, 0.85)),
    "CIRC": (1, lambda r: Circle(2.0 * r, 0.89)),
    "PIPE": (2, lambda r, t: Tube(2.0 * r, t, 0.53)),
    "BOX": (6, lambda a, b, *t: _box(a, b, *t)),
    "I": (7, lambda *sizes: _i_section(*sizes)),
}


@dataclass(frozen=True, eq=False)
class AbaqusModel:
    """A model from an input file, see `read_abaqus_model`.

    Parameters
    ----------
    model : Model
        The model.
    frame : Frame
        Its beams and joints, with the sets of the file: `frame.members(elset)`, `frame.points(nset)`.
    procedures : tuple of str
        Procedures of the steps, such as "STATIC" or "STATIC, RIKS".
    """

    model: Model
    frame: Frame
    procedures: tuple[str, ...]

    __repr__ = brief


def read_abaqus_model(
    path: str | PathLike[str], elements: int = 1, element: Element | None = None, units: str | None = None
) -> AbaqusModel:
    """Return the planar model of an Abaqus input file, in its units.

    It reads beams in one plane (B21, B22, B31, B32 and the like; the x and y of the model are x and z of a file whose
    y is constant, y and z where x is) and trusses (T2D2, hinged bars that do not buckle);
    *BEAM SECTION (RECT, CIRC, PIPE, BOX, I) with the shear coefficients of Abaqus, *BEAM GENERAL SECTION and *SOLID
    SECTION; *ELASTIC, *DENSITY, *EXPANSION, and the first yield stress of *PLASTIC as strength; *BOUNDARY, *CLOAD, and
    *DLOAD of types PX, PY, PZ, P2 and GRAV. Loads and displacements are those at the end of the last step. Elements in
    sequence become one beam. Deflections are always large, with or without NLGEOM. CalculiX files can be read too; the
    size of a CIRC section is the radius, as in Abaqus, and the diameter, as in CalculiX, if there are B31R or B32R.

    Parameters
    ----------
    path : path
        The input file.
    elements : int, default 1
        Finite elements for each element of the file.
    element : Element, optional
        Element of the beams, by default `CRBF(order=2)`.
    units : str, optional
        Units that the numbers of the file have, such as "N, mm", for labels and tables as in `Model`, by default
        "N, m, s". Nothing is converted.

    Raises
    ------
    FileError
        If the system refuses to read the file; FileNotFoundError if there is none.
    InputError
        For a file that cannot be read, an element without section or material, a section that is not read, for unknown
        units, and for anything that `read_mesh` refuses.

    Warns
    -----
    NotReadWarning
        Names what is left out, such as amplitudes, constraints and releases, and what is interpreted differently.

    Examples
    --------
    >>> file = bf.read_abaqus_model("frame.inp")  # doctest: +SKIP
    >>> solution = bf.solve_static(file.model)  # doctest: +SKIP
    >>> tip = file.frame.points("TIP")[0]  # doctest: +SKIP
    """
    source = readable(path)
    keywords = list(keywords_of(source))
    content, plane = _planar(content_of(source, keywords, _TRUSSES), keywords)
    kinds = [keyword.parameters.get("TYPE", "").upper() for keyword in keywords if keyword.keyword == "ELEMENT"]
    reading = _Reading(plane, calculix=any(kind in ("B31R", "B32R") for kind in kinds))
    for keyword in keywords:
        reading.take(keyword)
    try:
        frame = reading.frame(line_mesh(content, False), elements, CRBF(order=2) if element is None else element)
        model = reading.model(frame, "N, m, s" if units is None else units)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    if reading.notes:
        warn(f"{source}: left out, or read in another sense: {listed(reading.notes)}", NotReadWarning)
    return AbaqusModel(model, frame, tuple(reading.procedures))


@dataclass
class _Reading:
    """What keywords have said so far; names in capitals."""

    plane: tuple[int, int, int]
    calculix: bool
    materials: dict[str, dict[str, float]] = field(default_factory=dict)
    sections: dict[str, tuple[Any, str | Material | None]] = field(default_factory=dict)
    held: dict[tuple[str, int], float] = field(default_factory=dict)
    forces: dict[tuple[str, int, bool], float] = field(default_factory=dict)
    along: dict[tuple[str, str], list[float]] = field(default_factory=dict)
    procedures: list[str] = field(default_factory=list)
    notes: dict[str, None] = field(default_factory=dict)

    def note(self, text: str) -> None:
        self.notes[text] = None

    def take(self, keyword: Keyword) -> None:
        """Take over a keyword. Raises InputError, with its line, if it cannot be read."""
        try:
            self._take(keyword, keyword.parameters)
        except InputError as error:
            raise InputError(f"{keyword.place}: {error}") from None
        except (ValueError, IndexError, KeyError, ZeroDivisionError) as error:
            raise InputError(f"{keyword.place}: this line below *{keyword.keyword} cannot be read: {error}") from error

    def _take(self, keyword: Keyword, given: dict[str, str]) -> None:
        kind, rows = keyword.keyword, keyword.rows
        match kind:
            case "MATERIAL":
                self.materials[given["NAME"].upper()] = {}
            case "ELASTIC" | "DENSITY" | "EXPANSION" | "PLASTIC" if self.materials:
                names = ("youngs_modulus", "poisson_ratio") if kind == "ELASTIC" else _OF_MATERIAL[kind]
                self.materials[next(reversed(self.materials))] |= dict(zip(names, _numbers(rows[0]), strict=False))
                if kind == "PLASTIC":
                    self.note("*PLASTIC (its first yield stress is the strength)")
            case "BEAM SECTION" | "BEAM GENERAL SECTION":
                if any(number(given.get(name, "0")) for name in ("OFFSET1", "OFFSET2")):
                    self.note(f"the offset of *{kind}")
                shape = given.get("SECTION", "GENERAL").upper().replace("RECTANGULAR", "RECT")
                if "MATERIAL" in given:  # CalculiX has it for general sections too
                    self.sections[given["ELSET"].upper()] = self._shape(shape, rows), given["MATERIAL"].upper()
                else:
                    density = number(given.get("DENSITY", "1"))
                    self.sections[given["ELSET"].upper()] = self._general(shape, rows, density)
            case "SOLID SECTION":
                area = _numbers(rows[0])[0] if rows else 1.0
                self.sections[given["ELSET"].upper()] = area, given["MATERIAL"].upper()
            case "BOUNDARY" | "CLOAD" | "DLOAD":
                self._act(kind, given, rows)
            case "STEP":
                if given.get("NLGEOM", "YES" if "NLGEOM" in given else "NO").upper() == "NO":
                    self.note("*STEP without NLGEOM (deflections are large here)")
            case "STATIC" | "BUCKLE" | "FREQUENCY" | "DYNAMIC":
                self.procedures.append(", ".join([kind, *(name for name in given if name == "RIKS")]))
                if len(self.procedures) == 2:
                    self.note("steps before the last one (their loads are kept as far as it does not change them)")
            case _ if kind not in OF_THE_MESH and kind not in _PRINTED:
                self.note(f"*{kind}")

    def _act(self, kind: str, given: dict[str, str], rows: list[list[str]]) -> None:
        """Take over supports or loads: those of the same name and direction replace earlier ones."""
        if given.get("OP", "MOD").upper() == "NEW":
            earlier: dict[str, dict[Any, Any]] = {"BOUNDARY": self.held, "CLOAD": self.forces, "DLOAD": self.along}
            earlier[kind].clear()
        for target, what, *more in rows:
            name, values = target.rpartition(".")[2].upper(), _numbers(more)
            if kind == "DLOAD":
                x, y, z = self.plane
                names = {f"P{'XYZ'[x]}": "PX", f"P{'XYZ'[y]}": "PY", "GRAV": "GRAV"} | ({"P2": "P2"} if z == 2 else {})
                if what.upper() in names:
                    self.along[name, names[what.upper()]] = values
                else:
                    self.note(f"*DLOAD {what.upper()}")
            elif kind == "CLOAD":
                self.forces[name, int(what), "FOLLOWER" in given] = values[0]
            elif what.upper() in _SYMMETRIES:
                self.held |= {(name, direction): 0.0 for direction in _SYMMETRIES[what.upper()]}
            else:
                last = int(values[0]) if values and values[0] else int(what)
                value = values[1] if len(values) > 1 else 0.0
                self.held |= {(name, direction): value for direction in range(int(what), last + 1)}

    def material(self, name: str) -> Material:
        """Return a material. Raises InputError if the file does not define it."""
        if not (numbers := self.materials.get(name)):
            raise InputError(f"there is no *MATERIAL {name} with an *ELASTIC line")
        if "density" not in numbers:
            self.note(f"no *DENSITY of {name} (it is 1)")
        return Material(**({"poisson_ratio": 0.0, "density": 1.0} | numbers))

    def frame(self, mesh: LineMesh, elements: int, element: Element) -> Frame:
        """Return beams along the elements; trusses are hinged, also to beams."""
        members = {name.upper(): name for name in mesh.member_sets}
        trusses = mesh.member_sets.get(_TRUSSES, np.empty(0, dtype=np.int64))
        ends = {**mesh.point_sets, _JOINED: np.unique(mesh.cells[trusses, :2])}
        sections, materials, counts = {}, {}, {}
        for name, (section, named) in self.sections.items():
            if name not in members:
                raise InputError(f"there is no elset {name} with beams or trusses, which has a section")
            own = members[name]
            material = self.material(named) if isinstance(named, str) else named
            if isinstance(section, float):
                assert material is not None
                start, end = (mesh.nodes[mesh.cells[mesh.member_sets[own], side]] for side in (0, 1))
                section, material = _bar(section, material, float(np.linalg.norm(end - start, axis=1).max())), None
                counts[own] = 1
            sections[own], materials[own], counts[own] = section, material, counts.get(own, elements)
        lines = LineMesh(mesh.nodes, mesh.cells, mesh.member_sets, ends)
        frame = build_frame(lines, counts, element, sections, materials, "chains", _JOINED)
        hinged = {id(frame.beams[number]) for number in frame.owner[trusses]}
        places = tuple(tuple(sorted(at_node, key=lambda at: id(at.beam) in hinged)) for at_node in frame.places)
        joints: list[Joint] = []
        for first, *others in filter(None, places):
            free = id(first.beam) in hinged
            joints += [(Hinge if free or id(other.beam) in hinged else Rigid)(first, other) for other in others]
        return replace(frame, places=places, joints=tuple(joints), mesh=mesh)

    def _shape(self, shape: str, rows: list[list[str]]) -> Section:
        """Return a section by its shape and sizes. Raises InputError for another shape."""
        if shape not in _SHAPES:
            raise InputError(f"SECTION={shape} cannot be read; {', '.join(_SHAPES)} can")
        count, make = _SHAPES[shape]
        sizes = _numbers(rows[0])[:count]
        if len(sizes) < count:
            raise InputError(f"SECTION={shape} needs {count} sizes, got {len(sizes)}")
        if shape == "CIRC" and self.calculix:
            self.note("SECTION=CIRC (its size is the diameter, as in CalculiX: B31R and B32R are its elements)")
            sizes = [0.5 * sizes[0]]
        if len(rows) > 1 and self._first_in_plane(rows[1]):
            if shape not in ("RECT", "CIRC", "PIPE"):
                raise InputError(f"SECTION={shape}: its first axis must be normal to the plane")
            sizes = sizes[::-1] if shape == "RECT" else sizes
        return make(*sizes)

    def _first_in_plane(self, row: list[str]) -> bool:
        """Return whether the first axis of a section, if a row has it, is in the plane: bending is about the second."""
        if len(row) < 3:
            return False
        x, y, z = (abs(number(row[axis])) for axis in self.plane)
        return z < max(x, y)

    def _general(self, shape: str, rows: list[list[str]], density: float) -> tuple[Any, Material | None]:
        """Return a section whose elasticity is on its last line: E and G."""
        modulus, shear = _numbers(rows[-1])[:2]
        if shape == "GENERAL":
            area, *moments = _numbers(rows[0])
            second = moments[0]
            if len(moments) > 2:
                if moments[1]:
                    self.note("the product of inertia I12 of *BEAM GENERAL SECTION")
                second = moments[2] if len(rows) > 2 and self._first_in_plane(rows[1]) else second
            inertia = density * area, density * second
            return Section.from_stiffness(modulus * area, shear * area, modulus * second, *inertia), None
        return self._shape(shape, rows[:-1]), Material(modulus, modulus / (2.0 * shear) - 1.0, density)

    def _planar(self, direction: int, value: float) -> str:
        """Return the name of a direction in the plane, or ""; values in others are noted."""
        x, y, z = self.plane
        name = {x + 1: "ux", y + 1: "uy", z + 4: "rotation"}.get(direction, "")
        if not name and value:
            self.note(f"loads and displacements in direction {direction}, out of the plane")
        return name

    def model(self, frame: Frame, units: str) -> Model:
        """Return the model with supports and loads. Raises InputError for sets and numbers that the file lacks."""
        names = {name.upper(): name for name in frame.mesh.point_sets}
        turn = -1.0 if self.plane == (0, 2, 1) else 1.0  # from x to z is against y
        held: dict[int, dict[str, float]] = {}
        for (name, direction), value in self.held.items():
            way = self._planar(direction, value)
            for node in _nodes(frame, names, name) if way else ():
                held.setdefault(node, {})[way] = turn * value if way == "rotation" else value
        supports = [_support(_point(frame, node), values) for node, values in held.items()]
        loads: list[Load] = []
        for (name, direction, follower), value in self.forces.items():
            way = self._planar(direction, value)
            for node in _nodes(frame, names, name) if way else ():
                point = _point(frame, node)
                if way == "rotation":
                    loads.append(PointMoment(point, turn * value))
                else:
                    vector = (value, 0.0) if way == "ux" else (0.0, value)
                    loads.append(PointForce(point, vector, follower=follower))
        return Model(frame.beams, supports, [*loads, *self._along_beams(frame)], joints=frame.joints, units=units)

    def _along_beams(self, frame: Frame) -> Iterator[Load]:
        names = {name.upper(): name for name in frame.mesh.member_sets}
        for (name, kind), values in self.along.items():
            if kind == "GRAV":
                size, *vector = values
                yield Gravity((size * vector[self.plane[0]], size * vector[self.plane[1]]))
                if name and len(frame.members(_known(names, "elset", name))) < len(frame.beams):
                    self.note(f"*DLOAD GRAV of {name} alone (all beams have weight)")
                continue
            set_name = _known(names, "elset", name)
            for beam in frame.members(set_name):
                if kind == "P2":
                    cells = [
                        cell for cell in frame.mesh.member_sets[set_name] if frame.beams[frame.owner[cell]] is beam
                    ]
                    ways = {_runs_along(frame, cell) for cell in cells}
                    if len(ways) > 1:
                        raise InputError(f"*DLOAD P2 of {name}: its elements follow each other in opposite directions")
                    yield Pressure(beam, values[0] if ways == {True} else -values[0])
                else:
                    yield DistributedLoad(beam, (values[0], 0.0) if kind == "PX" else (0.0, values[0]))


def _planar(content: MeshFile, keywords: list[Keyword]) -> tuple[MeshFile, tuple[int, int, int]]:
    """Return the mesh with its plane as z = 0, and that plane: of a straight line, the first that no load leaves."""
    nodes = np.concatenate([np.empty(0, dtype=np.int64), *(nodes.ravel() for _, nodes in content.blocks)])
    size = np.ptp(content.points[nodes], axis=0) if nodes.size else np.zeros(3)
    flat = [plane for plane in _PLANES if size[plane[2]] <= 1e-9 * size.max()]
    acting = [row for keyword in keywords if keyword.keyword in ("CLOAD", "DLOAD") for row in keyword.rows]

    def leaves(plane: tuple[int, int, int]) -> bool:
        x, y, axis = plane
        outside = {f"P{'XYZ'[axis]}", str(axis + 1), str(x + 4), str(y + 4)}
        across = [row[2:3] for row in acting if outside & set(row[1:2])]
        across += [row[3 + axis : 4 + axis] for row in acting if row[1:2] == ["GRAV"]]
        return any(set("".join(words)) & set("123456789") for words in across)

    plane = min(flat, key=leaves, default=_PLANES[0])
    points = content.points[:, plane]
    if flat and nodes.size:
        points[:, 2] -= points[nodes[0], 2]
    return replace(content, points=points), plane


def _numbers(row: list[str]) -> list[float]:
    return [number(word) for word in row]


def _known(names: dict[str, str], kind: str, name: str) -> str:
    if name not in names:
        raise InputError(f"there is no {kind} {name}, which has a support or load")
    return names[name]


def _nodes(frame: Frame, names: dict[str, str], name: str) -> list[int]:
    """Return the nodes of a set. Raises InputError for a node that no element has."""
    nodes = frame.mesh.point_sets[_known(names, "nset", name)].tolist()
    if any(node not in frame.mesh.cells or node < 0 for node in nodes):
        raise InputError(f"nset or node {name} has a support or load where there is no element")
    return nodes


def _point(frame: Frame, node: int) -> Point:
    """Return the point at a node, which may be in the middle of an element."""
    if places := frame.places[node]:
        return places[0]
    cell = int(np.argmax(frame.mesh.cells[:, 2] == node))
    beam, ends = frame.beams[frame.owner[cell]], frame.mesh.cells[cell, :2]
    first, last = (next(at.fraction for at in frame.places[end] if at.beam is beam) for end in ends)
    before, behind = np.linalg.norm(frame.mesh.nodes[ends] - frame.mesh.nodes[node], axis=1)
    return beam.at(float(first + (last - first) * before / (before + behind)))


def _runs_along(frame: Frame, cell: int) -> bool:
    """Return whether an element runs in the direction of its beam."""
    beam = frame.beams[frame.owner[cell]]
    start, end, _ = frame.mesh.cells[cell].tolist()
    first, last = ([at.fraction for at in frame.places[node] if at.beam is beam] for node in (start, end))
    return min(first) < max(last)


def _support(point: Point, values: dict[str, float]) -> PointSupport:
    if not any(values.values()):
        if len(values) == 3:
            return Clamp(point)
        if "rotation" not in values and len(values) == 2:
            return Pin(point)
    return Prescribed(point, **values)


def _bar(area: float, material: Material, length: float) -> StiffnessSection:
    """Return the section of a truss, so stiff in bending that it never buckles, as those of Abaqus do not."""
    axial, mass = material.youngs_modulus * area, material.density * area
    return Section.from_stiffness(axial, axial, 0.1 * axial * length**2, mass, 1e-6 * mass * length**2)


def _box(a: float, b: float, right: float, top: float, left: float, bottom: float) -> Section:
    if top != bottom:
        raise InputError("SECTION=BOX: the walls above and below must be equal, with the nodes at the centroid")
    outer = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)]
    hole = [(left, bottom), (a - right, bottom), (a - right, b - top), (left, b - top)]
    return Polygon(outer, [hole], 0.44)


def _i_section(axis: float, h: float, lower: float, upper: float, t1: float, t2: float, web: float) -> Section:
    right = [(lower, 0.0), (lower, t1), (web, t1), (web, h - t2), (upper, h - t2), (upper, h)]
    section = Polygon([(0.5 * x, y) for x, y in right] + [(-0.5 * x, y) for x, y in reversed(right)], shear_factor=0.44)
    if abs(axis + section.bounds[0]) > 1e-3 * h:
        raise InputError("SECTION=I: the nodes must be at the centroid of the section")
    return section
