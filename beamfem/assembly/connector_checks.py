"""Checks of connectors: analytic, symmetric if they have a potential, and with energies that match their forces."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.connector import COMPLEX_STEP, Connector, Motion
from beamfem.errors import InputError
from beamfem.model.contribution import remembered

_WIDTH = 1e-7  # of the central differences to which complex steps are compared
_NEAR = 1e-3  # distance from the reference at which a force is checked, relative to the length
_AGREE = 1e-4
_GRAVITY = np.array([0.3, -0.7])  # arbitrary
_TIMES = (0.5, 0.0, 0.813)


def require_analytic(item: Connector) -> None:
    """Raise InputError if a force or energy is not analytic, or if they are inconsistent."""
    (p, v, a), size = _somewhere(item)
    moving, resting = (p, v, a), (p, 0.0 * v, 0.0 * a)
    if not np.isfinite(item.force(item.at(moving, _TIMES[0], _GRAVITY))).all():
        raise InputError(f"force of {item.name} is not finite near the reference")
    try:
        for kind, width in enumerate((_WIDTH * size, _WIDTH, _WIDTH)):
            exact = item.tangent(moving, _TIMES[0], _GRAVITY, [float(kind == number) for number in range(3)])
            _require_same(f"force of {item.name}", "qva"[kind], exact, _slopes(item, item.force, moving, kind, width))
        stiffness = item.tangent(resting, _TIMES[0], _GRAVITY, (1.0, 0.0, 0.0))
    except LinAlgError as error:
        raise InputError(f"{error} near the reference") from error
    exact = np.array([_kinetic_rate(item, moving, dof) for dof in item.dofs.tolist()])
    slopes = _slopes(item, lambda at: np.array([item.energy(at)[0]]), moving, 1, _WIDTH)[0, : len(item.dofs)]
    _require_same(f"kinetic energy of {item.name}", "v", exact, slopes)
    if not item.item.conservative:
        return
    uneven = np.abs(stiffness - stiffness.T).max(initial=0.0)
    if uneven > _AGREE * np.abs(stiffness).max(initial=0.0):
        raise InputError(
            f"{item.name} says that it is conservative, but its stiffness is not symmetric: its force is not the "
            "derivative of a potential"
        )
    p = p.copy()
    p[item.own] = 0.0
    resting = (p, 0.0 * v, 0.0 * a)
    force = item.force(item.at(resting, _TIMES[0], _GRAVITY)).real[: len(item.dofs)]
    slope = _slopes(item, lambda at: np.array([item.energy(at)[1]]), resting, 0, _WIDTH * size)[0, : len(item.dofs)]
    if not np.all(np.abs(force - slope) <= _AGREE * np.maximum(np.abs(force).max(), np.abs(slope).max())):
        raise InputError(
            f"{item.name} says that it is conservative, but the potential of its energy() is not that of its force: "
            f"the force is {force}, the derivative of the potential, the second number of energy(), {slope}"
        )


def resists_rates(item: Connector) -> bool:
    """Return whether the force depends on velocities."""
    return bool(item.tangent(_somewhere(item)[0], _TIMES[0], _GRAVITY, (0.0, 1.0, 0.0)).any())


def follows_time(item: Connector) -> tuple[bool, bool]:
    """Return whether the force and whether the constraint conditions depend on time."""
    motion = _somewhere(item)[0]
    first, *others = (item.force(item.at(motion, time, _GRAVITY)).real for time in _TIMES)
    changed = np.any([other != first for other in others], axis=0)
    return bool(changed[: len(item.dofs)].any()), bool(changed[len(item.dofs) :].any())


def _somewhere(item: Connector) -> tuple[Motion, float]:
    """Return an arbitrary motion near the reference, and the length [m] of the longest connected beam."""
    rng, size = np.random.default_rng(3), max(point.beam.curve.length for point in item.item.points)
    last = int(max(item.all.max(), item.memory.max(initial=0))) + 1
    p, v, a = (_NEAR * size * rng.standard_normal(last) for _ in range(3))
    p[item.dofs] += item.reference.ravel()
    p[item.memory] = remembered(item.item)
    return (p, v, a), size


def _require_same(name: str, of: str, exact: np.ndarray, slopes: np.ndarray) -> None:
    if not np.all(np.abs(exact - slopes) <= _AGREE * np.abs(slopes).max(initial=0.0)):
        raise InputError(
            f"{name} is no analytic function of {of}: its derivative by complex steps is not that of differences. "
            "Write lengths as np.sqrt(x**2 + y**2), not abs, np.hypot or np.linalg.norm, and keep "
            "complex numbers complex: no float()"
        )


def _kinetic_rate(item: Connector, motion: Motion, dof: int) -> float:
    moved = motion[1].astype(complex)
    moved[dof] += 1j * COMPLEX_STEP
    try:
        kinetic = item.energy(item.at((motion[0], moved, motion[2]), _TIMES[0], _GRAVITY))[0]
    except InputError:  # such as float() of a complex number
        return np.nan
    return float(np.imag(kinetic)) / COMPLEX_STEP


def _slopes(item: Connector, values: Callable[..., np.ndarray], motion: Motion, kind: int, width: float) -> np.ndarray:
    """Return the derivative of `values` with respect to p, p' or p'' (kind 0, 1 or 2), by central differences."""
    columns = []
    for dof in item.all.tolist():
        ends = []
        for side in (1.0, -1.0):
            moved = (motion[0].copy(), motion[1].copy(), motion[2].copy())
            moved[kind][dof] += side * width
            ends.append(np.real(values(item.at(moved, _TIMES[0], _GRAVITY))))
        columns.append((ends[0] - ends[1]) / (2.0 * width))
    return np.array(columns).T
