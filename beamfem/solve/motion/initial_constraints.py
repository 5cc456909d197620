"""The start of a motion on its supports: refused if they would make it jump, else exactly on them."""

import numpy as np

from beamfem.assembly.prescribed import coordinate_of
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.model.support_base import PointSupport

# of the largest displacement of the start, or of the size of the model if that is smaller: a jump along a slender beam
# strains it by far more than a deflection of the same size
_OFF = 1e-6
_SAME = 1e-9  # of the size of the model, and rad: the transfer of a state takes it for the same place
_ZERO = 1e-12  # of the size of the model, and rad: round-off in messages
_NAMES = {"r^x": "ux", "r^y": "uy", "theta": "rotation"}


def require_on_supports(system: System, p: np.ndarray, prescribed: np.ndarray, given: bool) -> None:
    """Raise InputError if a support would move its point from the start at once.

    p (n,): coordinates of the start; prescribed (nh,): values of the prescribed coordinates at time 0; given: whether
    the start is a state, not the reference.
    """
    moved = float(np.abs(p - system.reference)[system.positions].max()) / system.extent
    near = max(_OFF * min(moved, 1.0), _SAME)
    gaps = prescribed - p[system.prescribed_dofs]
    gaps -= _unfelt_turns(system, gaps)
    jumps = _large(system.prescribed_dofs, gaps, near * system.scale[system.prescribed_dofs])
    offsets = np.array([normal @ (p - system.reference)[dof : dof + 2] for dof, normal in system.inclined])
    slides = _large(np.array([dof for dof, _ in system.inclined]), offsets, near * system.extent)
    if not jumps and not slides:
        return
    for support in system.model.point_supports:
        mesh = system.model.mesh_of(support.point)
        numbers = mesh.coordinates_of(mesh.node_at(support.point.fraction))
        names = {direction: coordinate_of(support, direction) for direction in support.prescribed()}
        if any(name is not None and numbers[name] in jumps for name in names.values()):
            dofs = {direction: (_NAMES[name], numbers[name]) for direction, name in names.items() if name is not None}
            raise InputError(_jumping(system, support, p, dofs, jumps, given))
        if None in names.values() and numbers["r^x"] in slides:
            raise InputError(_sliding(system, support, slides[numbers["r^x"]]))


def put_onto_supports(system: System, state: np.ndarray, prescribed: np.ndarray) -> np.ndarray:
    """Give prescribed coordinates of a state p, p', p'' (4, n) their values (3, nh), and remove what rollers stop.

    Return the change of p' (n,).
    """
    before = state[1].copy()
    state[:3, system.prescribed_dofs] = prescribed
    for dof, normal in system.inclined:
        pair = slice(dof, dof + 2)
        state[0, pair] -= normal * (normal @ (state[0, pair] - system.reference[pair]))
        state[1, pair] -= normal * (normal @ state[1, pair])
    return np.asarray(state[1] - before)


def _unfelt_turns(system: System, gaps: np.ndarray) -> np.ndarray:
    """Return the full turns (nh,) [rad] in gaps of rotations that no spring or connector feels.

    The section stays where it is: a crank may go on with a function that begins at 0 again.
    """
    felt = np.concatenate([system.springs.dof, *(item.all for item in system.connectors.items)])
    rotations = np.array([item.rotation for item in system.prescribed], dtype=bool)
    unfelt = ~np.isin(system.prescribed_dofs, felt)
    return np.where(rotations & unfelt, 2.0 * np.pi * np.round(gaps / (2.0 * np.pi)), 0.0)


def _large(dofs: np.ndarray, gaps: np.ndarray, near: np.ndarray | float) -> dict[int, float]:
    """Return the gaps (n,) that are larger than a tolerance, by the number of their coordinate."""
    large = np.abs(gaps) > near
    return dict(zip(dofs[large].tolist(), gaps[large].tolist(), strict=True)) if large.any() else {}


def _jumping(
    system: System,
    support: PointSupport,
    p: np.ndarray,
    dofs: dict[str, tuple[str, int]],
    jumps: dict[int, float],
    given: bool,
) -> str:
    """Return the message that a support prescribes coordinates other than those of a start p (n,).

    dofs: name and number of the coordinate of each direction; jumps: change [m], [rad] of those that would jump; given:
    see `require_on_supports`.
    """
    metre, prescribed = system.model.unit("m"), support.prescribed()
    imposed, there, hold, driven = [], [], [], False
    sizes = {metre: 0.0, "rad": 0.0}
    for direction, (name, dof) in dofs.items():
        unit = "rad" if direction == "rotation" else metre
        value = p[dof] - system.reference[dof]
        hold.append(f"{name} = {_number(system, dof, value, 12)}")
        if dof in jumps:
            imposed.append(f"{name} = {_number(system, dof, value + jumps[dof])} {unit}")
            there.append(f"{name} = {_number(system, dof, value)} {unit}")
            sizes[unit] = float(np.hypot(sizes[unit], jumps[dof]))
            driven = driven or callable(prescribed[direction])
    jump = " and ".join(f"{size:.4g} {unit}" for unit, size in sizes.items() if size > 0.0)
    message = (
        f"{type(support).__name__} at {support.point}, prescribes {', '.join(imposed)} when the motion begins, but "
        f"{'start' if given else 'the reference'} has {', '.join(there)} there: it would jump by {jump}. "
    )
    if not given:
        if driven:
            start = "Subtract from its functions their values at time 0, or start from a static state with these values"
        else:
            start = "Use a function of time that begins at 0, or start from what solve_static finds with this support"
        return message + start
    message += f"To hold it where it is, use a Prescribed support with {', '.join(hold)}"
    if driven:
        return f"{message}; to continue a motion, shift the time of its functions, which begins at 0 again"
    return f"{message}; or start from what solve_static finds with this support"


def _sliding(system: System, support: PointSupport, beside: float) -> str:
    """Return the message that an inclined roller holds its point on a line that is a distance [m] away."""
    assert support.direction is not None
    x, y = support.direction.tolist()
    return (
        f"{type(support).__name__} at {support.point}, holds the displacement along ({x:.4g}, {y:.4g}) at 0, but start "
        f"has {beside:.4g} {system.model.unit('m')} there, by which it would jump; start from what solve_static finds "
        "with this support"
    )


def _number(system: System, dof: int, value: float, digits: int = 6) -> str:
    return f"{0.0 if abs(value) < _ZERO * system.scale[dof] else value:.{digits}g}"
