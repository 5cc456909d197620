"""The state that a solve starts from, also of another model that has the same beams and meshes."""

import numpy as np

from beamfem.element.coordinates import across
from beamfem.element.fields import cross, dot
from beamfem.equations.connectors import same_connectors
from beamfem.equations.model_coordinates import set_coordinates
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError, warn
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.model_meshes import required_nodes
from beamfem.mesh.reference import reference_angle
from beamfem.model.beam import beam_in_words
from beamfem.model.contribution import remembered
from beamfem.model.model import Model
from beamfem.results import postprocess
from beamfem.results.axis_points import nodal_vectors
from beamfem.results.check_arrays import require_finite
from beamfem.results.solution import Solution, State
from beamfem.solve.start.start_checks import left_over
from beamfem.value_keys import equal

_SAME_PLACE = 1e-9  # of the length of a beam: tolerance between positions of nodes
_ADVICE = "take it from a model of the same beams and elements, whose supports, loads and joints are at the same points"


def transferred(state: State, system: System, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (n,) of a state in the model of a system.

    Beams are matched by identity or, in a copy of their model, by position, in any order. Nodes are the same, but
    whether their coordinates are gradients or angles depends on supports and joints. Connectors that are in both models
    keep their history, multipliers and amplitudes, see `same_connectors`, and beams with the same element and section
    law their history.
    Raises InputError if the beams do not match.
    """
    source, target = state.model, system.model
    if source is target:
        return np.array(state.p), np.array(state.v)
    p, v = system.reference.copy(), np.zeros(target.size)
    pairs = matched(source, target, name)
    for old, new in pairs:
        values, rates = _by_label(old, state)
        set_coordinates(new, values, p)
        set_coordinates(new, rates, v)
        if _keeps_history(old, new):
            p[new.history] = state.p[old.history]
    beams = {old.beam: new.beam for old, new in pairs}
    known = same_connectors(system.connectors, system_of(source, system.static).connectors, beams)
    for item in system.connectors.items:
        if item in known:
            same = known[item]
            p[item.memory], p[item.own] = state.p[same.memory], state.p[same.own]
            p[item.amplitudes], v[item.amplitudes] = state.p[same.amplitudes], state.v[same.amplitudes]
        else:
            p[item.values] = item.values_in(p)
    return p, v


def warn_of_lost_history(state: State, system: System, name: str) -> None:
    """Warn of beams and connectors that have a history in a state which those here do not continue."""
    if state.model is system.model:
        return
    pairs = matched(state.model, system.model, name)
    own, others = (each.connectors for each in (system, system_of(state.model, system.static)))
    known = same_connectors(own, others, {old.beam: new.beam for old, new in pairs})
    left = [type(item.item) for item in own.items if item not in known]
    for item in others.items:
        kept = item in known.values() or type(item.item) not in left
        if not kept and not np.array_equal(state.p[item.memory], remembered(item.item)):
            warn(
                f"what the {item.name} remembers in {name} is lost: that of this model has other numbers or points, "
                "and begins without history"
            )
    for old, new in pairs:
        law = old.beam.law
        if law is None or not old.history.size or _keeps_history(old, new):
            continue
        if not np.array_equal(state.p[old.history], np.broadcast_to(law.start, old.history.shape)):
            beam = beam_in_words(system.model.beams, system.model.number_of(new.beam))
            warn(
                f"what the {law.name} of {beam} remembers in {name} is lost: the beam has another section, material or "
                "element in this model, which begins without history"
            )


def _keeps_history(old: BeamMesh, new: BeamMesh) -> bool:
    """Return whether a beam has the same element and section law in both models, and so its history."""
    one, other = old.beam.law, new.beam.law
    if one is None or other is None or not new.history.size or old.history.shape != new.history.shape:
        return False
    if old.beam.element != new.beam.element:
        return False
    return equal(one.section, other.section) and equal(one.material, other.material)


def transferred_turns(state: State | None, model: Model, name: str) -> np.ndarray:
    """Return the rotation at the start (m,) [rad], full turns included, of beams whose coordinates do not contain it.

    Zero without a state. Raises InputError if the beams do not match.
    """
    meshes = model.numbered.uncounted
    if state is None or not meshes:
        return np.zeros(len(meshes))
    pairs = zip(model.meshes, model.meshes, strict=True) if state.model is model else matched(state.model, model, name)
    old = {id(new): source for source, new in pairs}
    return np.array([_rotations(old[id(mesh)], state)[0] for mesh in meshes])


def _rotations(mesh: BeamMesh, state: State) -> np.ndarray:
    """Return the rotation of each node's section (nodes,) [rad] in a state."""
    indices = state.model.numbered.numbers_uncounted.get(mesh)
    turned = None if indices is None or state.turned is None else state.turned[[indices]]
    return np.asarray(postprocess.nodal_rotations(mesh, state.p[None], turned)[0])


def _by_label(mesh: BeamMesh, state: State) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return every coordinate that a node could have (nodes,), and its rate, by name."""
    p, v = state.p[None], state.v[None]
    e, rate = nodal_vectors(mesh, p)[0], nodal_vectors(mesh, p, v=v)[0]
    values: dict[str, np.ndarray] = {}
    rates: dict[str, np.ndarray] = {}
    for i, vector in enumerate(mesh.vectors):
        for component, axis in enumerate("xy"):
            values[f"{vector}^{axis}"], rates[f"{vector}^{axis}"] = e[:, i, component], rate[:, i, component]
    director, turning = e[:, -1], rate[:, -1]
    normal = -across(director)
    angle = np.arctan2(normal[:, 1], normal[:, 0]) - reference_angle(mesh)
    turns = np.round((_rotations(mesh, state) - angle) / (2.0 * np.pi))
    values["theta"] = angle + 2.0 * np.pi * turns
    rates["theta"] = cross(director, turning) / dot(director, director)
    if "r_x" in mesh.vectors:
        slope = e[:, mesh.vectors.index("r_x")]
        along = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        values["s"] = dot(slope, along)
        rates["s"] = dot(rate[:, mesh.vectors.index("r_x")], along)
    return values, rates


def matched(source: Model, target: Model, name: str) -> list[tuple[BeamMesh, BeamMesh]]:
    """Return the mesh of each beam in both models. Raises InputError if a beam has no counterpart."""
    by_beam = {id(mesh.beam): mesh for mesh in source.meshes}
    unmatched = [mesh for mesh in source.meshes if all(mesh.beam is not new.beam for new in target.meshes)]
    pairs = []
    for new in target.meshes:
        old = by_beam.get(id(new.beam)) or next((mesh for mesh in unmatched if _alike(mesh, new)), None)
        if old is None or not _alike(old, new):
            like = old or next((mesh for mesh in unmatched if _divided_equally(mesh, new)), None)
            if like is not None and (parted := _parted(source, target, like, new, name)):
                raise InputError(parted)
            other = [old] if old is not None else source.meshes[:5]
            beams = "; ".join(_described(source, mesh) for mesh in other)
            raise InputError(
                f"{name} does not have the {_described(target, new)} of this model, it has {beams}, or nodes elsewhere "
                f"in between; {_ADVICE}"
            )
        unmatched = [mesh for mesh in unmatched if mesh is not old]
        pairs.append((old, new))
    if unmatched:
        raise InputError(f"this model does not have the {_described(source, unmatched[0])} of {name}; {_ADVICE}")
    return pairs


def _alike(old: BeamMesh, new: BeamMesh) -> bool:
    """Return whether two beams have the same nodal vectors at the same places."""
    if old.vectors != new.vectors or old.nodes != new.nodes:
        return False
    near = _SAME_PLACE * new.arc[-1]
    distance = max(np.abs(old.position - new.position).max(), np.abs(old.arc - new.arc).max())
    turned = np.abs(old.tangent * old.speed[:, None] - new.tangent * new.speed[:, None]).max()
    return bool(distance <= near and turned <= _SAME_PLACE * new.speed.max())


def _divided_equally(old: BeamMesh, new: BeamMesh) -> bool:
    """Return whether two beams lie at the same place with the same elements, but for those that points divide."""
    if old.vectors != new.vectors or old.beam.elements != new.beam.elements:
        return False
    ends = np.abs(old.position[[0, -1]] - new.position[[0, -1]]).max()
    return bool(max(ends, abs(old.arc[-1] - new.arc[-1])) <= _SAME_PLACE * new.arc[-1])


def _parted(source: Model, target: Model, old: BeamMesh, new: BeamMesh, name: str) -> str:
    """Return the message that a part inside an element places a node in one model only; empty if none does.

    A divided element has more freedom than a whole one, so that no transfer between them is exact.
    """
    beam = beam_in_words(target.beams, target.number_of(new.beam))
    for one, mesh, other, lacks in ((source, old, new, "this model"), (target, new, old, f"the model of {name}")):
        fractions = other.vertices / other.vertices[-1]
        for at, part in sorted(required_nodes(one)[one.number_of(mesh.beam)]):
            if np.abs(fractions - at).min() > _SAME_PLACE:
                return (
                    f"there is a node on {beam} for {part} at fraction {at:.12g}, and {lacks} has none there; add a "
                    f"PointForce of (0, 0) at this point to {lacks}"
                )
    return ""


def _described(model: Model, mesh: BeamMesh) -> str:
    (x0, y0), (x1, y1) = mesh.position[[0, -1]]
    beam = beam_in_words(model.beams, model.number_of(mesh.beam))
    return f"{mesh.nodes} nodes of {mesh.beam.element.name} on {beam} from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g})"


_SAME = 1e-9  # of the size of the model, or rad: tolerance of prescribed coordinates


def last_state(given: State | Solution | None, name: str = "start") -> State | None:
    """Return a state as it is, and of a solution its last one. Raises InputError for anything else but None."""
    if isinstance(given, Solution):
        if not len(given):
            raise InputError(f"{name} must be a state, but this solution has no rows")
        return given[-1]
    if given is not None and not isinstance(given, State):
        raise InputError(f"{name} must be a state, such as solution[-1], or a solution, got a {type(given).__name__}")
    return given


def start_state(system: System, start: State | None, name: str = "start") -> np.ndarray:
    """Return the coordinates (n,) to start from: the reference, or those of a state of a compatible model."""
    if start is None:
        return system.reference.copy()
    require_finite(name, start)
    warn_of_lost_history(start, system, name)
    return transferred(start, system, name)[0]


def resting_state(system: System, about: State | Solution | None) -> tuple[np.ndarray, float]:
    """Return the coordinates (n,) of a static equilibrium and its load factor: the reference and 0 for None.

    about: a state, or a static solution for its last one; it may come from a model with other supports.
    Raises InputError for a state that moves, or is none of its load factor.
    """
    if isinstance(about, Solution) and not about.static:
        raise InputError(
            "about must be a static equilibrium, this solution is a motion", remedy="give one of solve_static"
        )
    about = last_state(about, "about")
    p = start_state(system, about, "about")
    if about is None:
        return p, 0.0
    if np.any(about.v) or np.any(about.a):
        raise InputError("about must be a state at rest, this one moves", remedy="take it from solve_static")
    _require_of_load_factor(system, about, p)
    return p, about.at


def _require_of_load_factor(system: System, about: State, p: np.ndarray) -> None:
    """Raise InputError if supports that move, or those of the state's own model, prescribe other coordinates (n,)."""
    own, load_factor, wrong = about.model is system.model, about.at, ""
    values = system.prescribed_values(load_factor)
    for item, value in zip(system.prescribed, values.tolist(), strict=True):
        moves = callable(item.value) or item.value != 0.0
        if not wrong and (own or moves) and abs(p[item.dof] - value) > _SAME * system.scale[item.dof]:
            wrong = f"a support prescribes {value:.6g} of a coordinate that is {p[item.dof]:.6g}"
    if not wrong and own and (force := left_over(system, p, load_factor)) > 0.0:
        wrong = f"it is not in equilibrium, a force of {force:.3g} is unbalanced"
    if wrong:
        raise InputError(
            f"about is no state of load factor {load_factor:g}, its at: {wrong}. Give a state of solve_static as it "
            "is, such as solution[-1]"
        )
