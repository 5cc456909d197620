"""The beam axis at points: the vectors that strain measures depend on."""

from typing import NamedTuple

import numpy as np


class Axis(NamedTuple):
    """r0, r0', r0'', d and d' (..., 2) at points of the axis; primes are by arc length of the reference."""

    r: np.ndarray
    r_s: np.ndarray
    r_ss: np.ndarray
    d: np.ndarray
    d_s: np.ndarray


def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the inner product over the last axis."""
    return np.asarray((u * v).sum(axis=-1))


def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the planar cross product over the last axis."""
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def section_frame(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors along the section's normal and along d (..., 2)."""
    across = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1), across
