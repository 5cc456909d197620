"""A contribution and its coordinates: its force, and its tangent by complex steps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.errors import InputError
from beamfem.model.contribution import At, Contribution
from beamfem.validation import called

COMPLEX_STEP = 1e-30  # nothing is subtracted, so it may be as small as this
_WIDTH = 1e-7  # of the central differences that complex steps are tested against
_NEAR = 1e-3  # of its size: how far from the reference a force is looked at
_AGREE = 1e-4
_GRAVITY = np.array([0.3, -0.7])  # any

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]  # p, p', p'' (n,)


@dataclass(frozen=True, eq=False)
class Connector:
    """A contribution and the coordinates that it acts on.

    dofs (3 m,): x, y and rotation of each point; own (k,): its unknowns; reference (m, 3): its q in the reference.
    """

    item: Contribution
    dofs: np.ndarray
    own: np.ndarray
    reference: np.ndarray

    @property
    def all(self) -> np.ndarray:
        """Numbers (3 m + k,) of all coordinates in its force."""
        return np.concatenate([self.dofs, self.own])

    @property
    def name(self) -> str:
        return type(self.item).__name__

    def at(self, motion: Motion, time: float, gravity: np.ndarray) -> At:
        """Return where it is evaluated; the motion may be complex."""
        q, rate, second = (values[self.dofs].reshape(-1, 3) for values in motion)
        return At(q, rate, second, motion[0][self.own], self.reference, time, gravity)

    def force(self, at: At) -> np.ndarray:
        """Return its force (3 m + k,). Raises InputError for what is no force."""
        with np.errstate(all="ignore"):  # far from equilibrium a force may overflow; then the iteration goes back
            found = np.asarray(called(f"force of {self.name}", self.item.force, at))
        if found.shape != (len(self.dofs) + len(self.own),) or found.dtype.kind not in "fic":
            raise InputError(
                f"force of {self.name} must return {len(self.dofs) + len(self.own)} numbers, fx, fy and moment at each "
                f"of its {len(self.reference)} points and {len(self.own)} conditions, got {found.dtype} {found.shape}"
            )
        return found

    def tangent(
        self,
        motion: Motion,
        time: float,
        gravity: np.ndarray,
        weights: Sequence[float],
    ) -> np.ndarray:
        """Return the derivative (3 m + k, 3 m + k) of its force, weighted for p, p' and p'', by complex steps.

        Raises LinAlgError where it is not finite.
        """
        every, columns = self.all, []
        for dof in every.tolist():
            moved = p, v, a = (motion[0].astype(complex), motion[1].astype(complex), motion[2].astype(complex))
            for values, weight in zip((p, v, a), weights, strict=True):
                values[dof] += 1j * COMPLEX_STEP * weight
            columns.append(self.force(self.at(moved, time, gravity)).imag / COMPLEX_STEP)
        result = np.array(columns).T
        if not np.isfinite(result).all():
            raise LinAlgError(f"force of {self.name} is not finite")
        return result


def require_analytic(item: Connector) -> None:
    """Raise InputError where complex steps are not derivatives of a force, or a stiffness is not as even as it says."""
    motion, size = _somewhere(item)
    for kind, width in enumerate((_WIDTH * size, _WIDTH, _WIDTH)):
        exact = item.tangent(motion, 0.5, _GRAVITY, [float(kind == number) for number in range(3)])
        differences = _differences(item, motion, kind, width)
        if not np.all(np.abs(exact - differences) <= _AGREE * np.abs(differences).max(initial=0.0)):
            raise InputError(
                f"force of {item.name} is no analytic function of {'qva'[kind]}: its derivative by complex steps is "
                "not that of differences. Write lengths as np.sqrt(x**2 + y**2), not abs, np.hypot or np.linalg.norm, "
                "and keep complex arrays complex"
            )
    resting = motion[0], 0.0 * motion[1], 0.0 * motion[2]
    stiffness = item.tangent(resting, 0.5, _GRAVITY, (1.0, 0.0, 0.0))
    uneven = np.abs(stiffness - stiffness.T).max(initial=0.0)
    if item.item.conservative and uneven > _AGREE * np.abs(stiffness).max(initial=0.0):
        raise InputError(
            f"{item.name} says that it is conservative, but its stiffness is not symmetric: its force is not the "
            "derivative of a potential"
        )


def resists_rates(item: Connector) -> bool:
    """Tell whether the force depends on velocities."""
    return bool(item.tangent(_somewhere(item)[0], 0.5, _GRAVITY, (0.0, 1.0, 0.0)).any())


def _somewhere(item: Connector) -> tuple[Motion, float]:
    """Return a motion near the reference, and the size [m] of what is between the points."""
    rng, size = np.random.default_rng(3), float(np.ptp(item.reference[:, :2], axis=0).max(initial=0.0)) or 1.0
    last = int(item.all.max()) + 1
    p, v, a = (_NEAR * size * rng.standard_normal(last) for _ in range(3))
    p[item.dofs] += item.reference.ravel()
    return (p, v, a), size


def _differences(item: Connector, motion: Motion, kind: int, width: float) -> np.ndarray:
    """Return the derivative of a force by p, p' or p'', by central differences."""
    columns = []
    for dof in item.all.tolist():
        slope = np.zeros(len(item.all))
        for side in (1.0, -1.0):
            moved = (motion[0].copy(), motion[1].copy(), motion[2].copy())
            moved[kind][dof] += side * width
            slope += side * item.force(item.at(moved, 0.5, _GRAVITY)).real / (2.0 * width)
        columns.append(slope)
    return np.array(columns).T
