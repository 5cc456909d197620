"""Reject models that are mechanisms if every beam is taken as rigid."""

from typing import NamedTuple

import numpy as np

from beamfem.assembly.system import System
from beamfem.errors import FreeMotionError
from beamfem.model.beam_names import beam_in_words
from beamfem.model.missing_joints import Pair, in_words, unjoined_ends
from beamfem.model.support_base import PointSupport
from beamfem.solve.start.body_motions import NEGLIGIBLE, Conditions, bodies_of, mechanisms

_PROVEN = "supported"


class FreeMotion(NamedTuple):
    """Motions (m, 3 bodies) of bodies that satisfy all conditions in the reference, and the error that names them."""

    conditions: Conditions
    motions: np.ndarray
    error: FreeMotionError


def require_support(system: System) -> None:
    """Raise FreeMotionError with a beam, a point and the motion if a rigid-body motion or a mechanism is possible."""
    found = free_motion(system)
    if found is not None:
        raise found.error


def free_motion(system: System) -> FreeMotion | None:
    """Return the rigid-body motions and mechanisms that are possible in the reference, None if there are none."""
    if _PROVEN in system.tables:
        return None
    model = system.model
    body = bodies_of(model)
    if len(body) == 1 and any(_fixes(support) for support in model.point_supports):
        system.tables[_PROVEN] = True
        return None
    rows = Conditions(system, body, system.reference)
    free = mechanisms(rows)
    if not len(free):
        system.tables[_PROVEN] = True
        return None
    sizes = np.abs(free[0].reshape(-1, 3)).max(axis=1)[body]
    # the first of those that move equally, whatever the round-off
    number = int(np.flatnonzero(sizes > (1.0 - 1e-6) * sizes.max())[0])
    motions = [motion.reshape(-1, 3)[body[number]] for motion in free]
    described = dict.fromkeys(
        "it " + describe(motion[:2] * system.extent, motion[2], rows.centre, system.extent)
        for motion in motions
        if np.abs(motion).max() > NEGLIGIBLE
    )
    start, end = model.beams[number].start, model.beams[number].end
    moved = [float(np.abs(rows.displacement(point) @ motions[0]).max()) for point in (start, end)]
    farthest = (start, end)[int(moved[1] > (1.0 + 1e-6) * moved[0])]
    x, y = farthest.reference
    unjoined = next((pair for pair in unjoined_ends(model) if _parts(rows, free, pair)), None)
    missing = f"{in_words(model, unjoined)}: add a Rigid or a Hinge. Otherwise a" if unjoined else "A"
    error = FreeMotionError(
        f"{beam_in_words(model.beams, number)} can move freely: {', '.join(described)}; its point ({x:g}, {y:g}) moves",
        remedy=f"{missing} static solve needs supports that hold it (a Clamp, or a Pin and a Roller) or joints that "
        "stiffen it (Rigid instead of Hinge); without them, use simulate",
    )
    return FreeMotion(rows, free, error)


def _parts(rows: Conditions, motions: np.ndarray, pair: Pair) -> bool:
    """Return whether motions (m, 3 bodies) part two points at one place, or turn them differently."""
    one, other = (int(rows.body[rows.model.number_of(point.beam)]) for point in pair)
    own = motions.reshape(len(motions), -1, 3)
    between = own[:, one] - own[:, other]
    apart = between @ np.vstack([rows.moved(pair[0].reference), [0.0, 0.0, 1.0]]).T
    return bool(np.abs(apart).max() > NEGLIGIBLE)


def _fixes(support: PointSupport) -> bool:
    """Return whether a support prescribes displacement and rotation of its point, which no rigid motion leaves."""
    return {"ux", "uy", "rotation"} <= support.prescribed().keys()


def describe(translation: np.ndarray, turn: float, origin: np.ndarray, reach: float) -> str:
    """Return a rigid motion in words: the velocity (2,) of the point `origin` and the rotation; reach: body size."""
    if abs(turn) * reach < 1e-6 * np.hypot(*translation):
        x, y = translation / np.hypot(*translation)
        if max(abs(x), abs(y)) > 1.0 - 1e-9:
            return f"translates along {'x' if abs(x) > abs(y) else 'y'}"
        return f"translates along ({abs(x):.3g}, {np.copysign(y, x * y):.3g})"
    centre = origin + np.array([-translation[1], translation[0]]) / turn
    x, y = np.where(np.abs(centre) < 1e-6 * reach, 0.0, centre)
    return f"turns about ({x:.6g}, {y:.6g})"
