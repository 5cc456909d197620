"""Models as input of other programs: an Abaqus input file, a script for OpenSeesPy.

Beams become straight two-node elements; Rigid joints share a node, hinges share its displacement.
"""

from dataclasses import dataclass, field
from itertools import count, groupby, pairwise
from os import PathLike
from typing import Any

import numpy as np

from beamfem.atomic_write import whole
from beamfem.errors import InputError, NotWrittenWarning, warn
from beamfem.model.beam import Point
from beamfem.model.joint_base import Joint
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.model.supports import DIRECTIONS, PointSupport
from beamfem.parts.distributed_load import DistributedLoad
from beamfem.parts.gravity import Gravity
from beamfem.parts.hinge import Hinge
from beamfem.parts.point_force import PointForce
from beamfem.parts.point_moment import PointMoment
from beamfem.parts.rigid import Rigid
from beamfem.parts.roller import Roller
from beamfem.section.protocol import Inertia, Rigidity
from beamfem.validation import number_below

_MOST = 1000  # pieces of an element
_DIGITS = 9  # of fractions of a beam that are one node
_Key = tuple[int, float]  # number of a beam and fraction
Piece = tuple[int, int, Rigidity, Inertia]  # its nodes, its stiffness and inertia


@dataclass
class _Written:
    """A model in straight pieces; directions are 0 (x), 1 (y) and 2 (rotation), nodes count from 1.

    places: of the nodes [m]; beams: pieces of each; hinges: pairs of nodes; held, forces: values by node and direction;
    lines: numbers of beams and forces per length [N/m]; others: kinds of parts that are left out.
    """

    places: list[tuple[float, float]] = field(default_factory=list)
    beams: list[list[Piece]] = field(default_factory=list)
    hinges: list[tuple[int, int]] = field(default_factory=list)
    held: dict[tuple[int, int], float] = field(default_factory=dict)
    forces: list[tuple[int, int, float, bool]] = field(default_factory=list)
    lines: list[tuple[int, np.ndarray]] = field(default_factory=list)
    gravity: np.ndarray = field(default_factory=lambda: np.zeros(2))
    others: dict[str, None] = field(default_factory=dict)


def write_abaqus(model: Model, path: str | PathLike[str], pieces: int = 4) -> None:
    """Write a model as an Abaqus input file of B21 elements with a static step for large deflections (NLGEOM).

    It has *BEAM GENERAL SECTION, *BOUNDARY, *CLOAD, *DLOAD, and *MPC, PIN for hinges. The elements of the first beam
    are the set BEAM-1, and so on.

    Parameters
    ----------
    model : Model
        The model.
    path : path
        File to write; folders are created.
    pieces : int, default 4
        Two-node elements for each element of the model.

    Raises
    ------
    InputError
        For sections whose stretch is coupled with their curvature.
    FileError
        If the system refuses to write.

    Warns
    -----
    NotWrittenWarning
        Names the kinds of parts that are left out.

    Examples
    --------
    >>> bf.write_abaqus(model, "cantilever.inp")
    """
    written, tags, axes = _in_pieces(model, pieces), count(1), (1, 2, 6)
    lines = ["*HEADING", "written by beamfem", "*NODE, NSET=ALL"]
    lines += [f"{number}, {x!r}, {y!r}" for number, (x, y) in enumerate(written.places, 1)]
    sections: list[str] = []
    for number, beam in enumerate(written.beams, 1):
        names: list[str] = []
        for (stiffness, inertia), alike in groupby(beam, key=lambda piece: piece[2:]):
            names.append(f"BEAM-{number}-{len(names) + 1}")
            lines += [f"*ELEMENT, TYPE=B21, ELSET={names[-1]}"]
            lines += [f"{next(tags)}, {start}, {end}" for start, end, *_ in alike]
            # with E = 1 the stiffness is that of the section, and G = k_s G A / (E A)
            shear, density = stiffness.shear / stiffness.axial, inertia.mass / stiffness.axial
            sections += [f"*BEAM GENERAL SECTION, SECTION=GENERAL, ELSET={names[-1]}, DENSITY={density!r}"]
            sections += [
                f"{stiffness.axial!r}, {stiffness.bending!r}, 0., {stiffness.bending!r}, {stiffness.bending!r}"
            ]
            sections += ["0., 0., -1.", f"1., {shear!r}"]
        lines += [f"*ELSET, ELSET=BEAM-{number}", *names]
    lines += sections
    for one, other in written.hinges:
        lines += ["*MPC", f"PIN, {other}, {one}"]
    for (node, axis), value in written.held.items():
        lines += ["*BOUNDARY", f"{node}, {axes[axis]}"] if value == 0.0 else []
    lines += ["*STEP, NLGEOM=YES", "*STATIC", "0.1, 1."]
    for (node, axis), value in written.held.items():
        lines += ["*BOUNDARY", f"{node}, {axes[axis]}, {axes[axis]}, {value!r}"] if value != 0.0 else []
    for node, axis, value, follower in written.forces:
        lines += [f"*CLOAD{', FOLLOWER' if follower else ''}", f"{node}, {axes[axis]}, {value!r}"]
    for beam_number, vector in written.lines:
        for kind, value in zip(("PX", "PY"), vector.tolist(), strict=True):
            lines += ["*DLOAD", f"BEAM-{beam_number + 1}, {kind}, {value!r}"] if value else []
    if size := float(np.hypot(*written.gravity)):
        x, y = (written.gravity / size).tolist()
        lines += ["*DLOAD", f", GRAV, {size!r}, {x!r}, {y!r}, 0."]
    _write(path, [*lines, "*OUTPUT, FIELD, VARIABLE=PRESELECT", "*END STEP"], written)


def write_opensees(model: Model, path: str | PathLike[str], pieces: int = 4) -> None:
    """Write a model as a script for OpenSeesPy: corotational beams with shear, and a static analysis.

    Forces along beams and weight become forces at nodes. Parameters, errors and warnings are those of `write_abaqus`;
    forces that follow a section are left out, too.

    Parameters
    ----------
    model : Model
        The model.
    path : path
        Script to write; folders are created.
    pieces : int, default 4
        Two-node elements for each element of the model.

    Examples
    --------
    >>> bf.write_opensees(model, "cantilever.py")
    """
    written, tags = _in_pieces(model, pieces), count(1)
    lines = ["import openseespy.opensees as ops", "", 'ops.wipe()\nops.model("basic", "-ndm", 2, "-ndf", 3)']
    lines += [f"ops.node({number}, {x!r}, {y!r})" for number, (x, y) in enumerate(written.places, 1)]
    lines += ['ops.geomTransf("Corotational", 1)']
    loads = np.zeros((len(written.places) + 1, 3))
    sections: dict[Rigidity, int] = {}
    for number, beam in enumerate(written.beams):
        per_length = sum((vector for loaded, vector in written.lines if loaded == number), np.zeros(2))
        for start, end, stiffness, inertia in beam:
            if stiffness not in sections:
                section = sections[stiffness] = len(sections) + 1
                # E = 1, A = E A, I = E I, G = 1 and the shear factor k_s G A / (E A)
                numbers = f"1.0, {stiffness.axial!r}, {stiffness.bending!r}, 1.0, {stiffness.shear / stiffness.axial!r}"
                lines.append(f'ops.section("Elastic", {section}, {numbers})')
                lines.append(f'ops.beamIntegration("Lobatto", {section}, {section}, 3)')
            own = f"{next(tags)}, {start}, {end}, 1, {sections[stiffness]}"
            lines.append(f'ops.element("forceBeamColumn", {own})')
            length = np.hypot(*np.subtract(written.places[end - 1], written.places[start - 1]))
            half = 0.5 * length * (per_length + inertia.mass * written.gravity)
            for node in (start, end):
                loads[node, :2] += half
    lines += [f"ops.equalDOF({one}, {other}, 1, 2)" for one, other in written.hinges]
    lines += [
        f"ops.fix({node}, {', '.join(str(int(axis == own)) for own in range(3))})"
        for (node, axis), value in written.held.items()
        if value == 0.0
    ]
    for node, axis, value, follower in written.forces:
        if follower:
            written.others["PointForce that follows a section"] = None
        else:
            loads[node, axis] += value
    lines += ['ops.timeSeries("Linear", 1)\nops.pattern("Plain", 1, 1)']
    lines += [
        f"ops.load({node}, {', '.join(map(repr, loads[node].tolist()))})" for node in np.flatnonzero(loads.any(1))
    ]
    lines += [f"ops.sp({node}, {axis + 1}, {value!r})" for (node, axis), value in written.held.items() if value != 0.0]
    lines += ['ops.constraints("Transformation")\nops.numberer("RCM")\nops.system("BandGeneral")']
    lines += ['ops.test("NormDispIncr", 1e-10, 100)\nops.algorithm("Newton")\nops.integrator("LoadControl", 0.05)']
    lines += ['ops.analysis("Static")\nif ops.analyze(20) != 0:\n    raise SystemExit("OpenSees found no equilibrium")']
    lines += ["for node in ops.getNodeTags():\n    print(node, *ops.nodeDisp(node))"]
    _write(path, lines, written)


def _write(path: str | PathLike[str], lines: list[str], written: _Written) -> None:
    with whole(path) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")
    if written.others:
        warn(f"{path}: left out: {', '.join(written.others)}", NotWrittenWarning)


def _in_pieces(model: Model, pieces: int) -> _Written:
    """Return a model in straight pieces. Raises InputError for a section with coupled stretch and curvature."""
    number_below("pieces", pieces, _MOST + 1, 1)
    result = _Written()
    shared: dict[_Key, _Key] = {}
    for joint in model.joints:
        if isinstance(joint, Rigid):
            shared[_first(shared, _key(model, joint.b))] = _first(shared, _key(model, joint.a))
    nodes: dict[_Key, int] = {}
    points = {_key(model, point) for part in (*model.supports, *model.loads, *model.joints) for point in _points(part)}
    for number, (beam, mesh) in enumerate(zip(model.beams, model.meshes, strict=True)):
        ends = mesh.vertices / mesh.vertices[-1]
        fractions = [np.linspace(*pair, pieces + 1) for pair in pairwise(ends)]
        fractions += [np.array([fraction for own, fraction in points if own == number])]
        every = np.unique(np.round(np.concatenate(fractions), _DIGITS)).tolist()
        for fraction, place in zip(
            every, beam.curve.position(np.array(every) * beam.curve.length).tolist(), strict=True
        ):
            first = _first(shared, (number, fraction))
            if first not in nodes:
                result.places.append(tuple(place))
                nodes[first] = len(result.places)
            nodes[number, fraction] = nodes[first]
        result.beams.append([])
        for a, b in pairwise(every):
            section = beam.section_at(0.5 * (a + b) * beam.curve.length)
            stiffness = section.rigidity(beam.material)
            if stiffness.coupling:
                raise InputError("a section whose stretch is coupled with its curvature cannot be written")
            result.beams[-1].append((nodes[number, a], nodes[number, b], stiffness, section.inertia(beam.material)))
    missing = {
        "laws of sections (they are linear here)": any(beam.law is not None for beam in model.beams),
        "damping": any(beam.damping is not None for beam in model.beams),
        "RotatingFrame": model.frame is not None,
    }
    result.others |= dict.fromkeys(name for name, is_there in missing.items() if is_there)
    for part in (*model.supports, *model.loads, *model.joints, *model.connectors, *model.masses):
        if not _added(result, model, part, [nodes[_key(model, point)] for point in _points(part)]):
            result.others[type(part).__name__] = None
    return result


def _added(result: _Written, model: Model, part: Any, nodes: list[int]) -> bool:
    """Add a part at these nodes; return whether it can be."""
    match part:
        case Rigid():
            return True
        case Hinge():
            result.hinges.append((nodes[0], nodes[1]))
            return True
        case PointSupport():
            values = dict(part.prescribed())
            if isinstance(part, Roller):
                values = {"ux": 0.0} if part.normal[1] == 0.0 else {"uy": 0.0} if part.normal[0] == 0.0 else {}
            numbers = {key: value for key, value in values.items() if key in DIRECTIONS and not callable(value)}
            if not numbers or len(numbers) < len(values):
                return False
            result.held |= {(nodes[0], DIRECTIONS.index(key)): value for key, value in numbers.items()}
            return True
        case Load() if part.amplitude is not None or not part.scale:
            return False
        case PointForce():
            result.forces += [(nodes[0], axis, value, part.follower) for axis, value in enumerate(part.vector) if value]
            return True
        case PointMoment():
            result.forces.append((nodes[0], 2, part.moment, False))
            return True
        case DistributedLoad() if not callable(part.vector) and not part.follower:
            result.lines.append((model.number_of(part.beam), np.array(part.vector)))
            return True
        case Gravity():
            result.gravity = result.gravity + part.vector
            return True
    return False


def _points(part: Any) -> list[Point]:
    """Return the points of a part that is written."""
    at = (part.a, part.b) if isinstance(part, Joint) else (getattr(part, "point", None),)
    return [point for point in at if isinstance(point, Point)]


def _key(model: Model, point: Point) -> _Key:
    return model.number_of(point.beam), round(point.fraction, _DIGITS)


def _first(shared: dict[_Key, _Key], key: _Key) -> _Key:
    """Return the first of the points that share a node."""
    while key in shared and shared[key] != key:
        key = shared[key]
    return key
