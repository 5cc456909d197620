"""Nodal coordinates: the numbers p that determine the nodal vectors e of a field."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH
from beamfem.physics import kinematics
from beamfem.validation import flag


@dataclass(frozen=True)
class Gradients:
    """p = e: position vector gradients as coordinates, with a constant mass matrix. Source: Omar and Shabana 2001."""

    name: ClassVar[str] = "gradients"
    code: ClassVar[int] = GRADIENTS


@dataclass(frozen=True)
class Rotation:
    """Rotations as coordinates: r_y = (-sin t, cos t), with t relative to the reference.

    Source: paper, eqs. (5) to (7), (11), (12).
    """

    name: ClassVar[str] = "rotation"
    code: ClassVar[int] = ROTATION


@dataclass(frozen=True)
class ShearFree:
    """Coordinates without shear at the nodes: r_x = s (cos t, sin t), r_y = (-sin t, cos t).

    The field must have r_x. Source: paper, sections 1.5 and 3.5.

    Parameters
    ----------
    stretchable : bool, default True
        Whether s is a coordinate; otherwise it stays as in the reference (1 by arc length).
    """

    stretchable: bool = True

    def __post_init__(self) -> None:
        flag("stretchable", self.stretchable)

    @property
    def name(self) -> str:
        """Name of the coordinates, as part of the names of elements."""
        return "stretch" if self.stretchable else "shear-rigid"

    @property
    def code(self) -> int:
        """Number of the coordinates in compiled code."""
        return STRETCH if self.stretchable else SHEAR_RIGID


Coordinates = Gradients | Rotation | ShearFree


KINEMATICS = {ROTATION: kinematics.ROTATION, STRETCH: kinematics.STRETCH, SHEAR_RIGID: kinematics.SHEAR_RIGID}
_STEP = 2.0**-300  # complex step, so small that its square is negligible


@lru_cache(maxsize=64)
def labels(node_kind: int, vectors: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of a node's coordinates: components of nodal vectors, then stretch and angle, if any."""
    kind = KINEMATICS.get(node_kind)
    components = tuple(f"{vector}^{axis}" for vector in vectors for axis in "xy")
    return components if kind is None else (*components[: -kind.size], *kind.coordinates)


def nodal_vectors(node_kind: int, vectors: tuple[str, ...], p: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """Return e (steps, nodes, vectors, 2) for coordinates p (steps, nodes, npn); frame (nodes, 3): as in `Block`."""
    kind = KINEMATICS.get(node_kind)
    p = p[..., : len(labels(node_kind, vectors))]
    if kind is not None:
        angle = np.cos(p[..., -1]), np.sin(p[..., -1])
        return _vectors_of(kind, p, *_rotated(*angle, frame), frame)
    result = p.reshape(*p.shape[:2], len(vectors), 2).copy()
    if node_kind == ROTATED_GRADIENTS:
        result[:, :, -1] = np.stack(_rotated(result[:, :, -1, 0], result[:, :, -1, 1], frame), axis=-1)
    return result


def nodal_rates(
    node_kind: int, vectors: tuple[str, ...], p: np.ndarray, v: np.ndarray, frame: np.ndarray
) -> np.ndarray:
    """Return e' = B p' (steps, nodes, vectors, 2) for p and p' (steps, nodes, npn), by a complex step along p'."""
    kind, count = KINEMATICS.get(node_kind), len(labels(node_kind, vectors))
    if kind is None:
        return nodal_vectors(node_kind, vectors, v, frame)
    p, v = p[..., :count], v[..., :count]
    c, s = _rotated(np.cos(p[..., -1]), np.sin(p[..., -1]), frame)
    spin = 1j * _STEP * v[..., -1]
    return _vectors_of(kind, p + 1j * _STEP * v, c - spin * s, s + spin * c, frame).imag / _STEP


def _vectors_of(
    kind: kinematics.Kinematics, p: np.ndarray, c: np.ndarray, s: np.ndarray, frame: np.ndarray
) -> np.ndarray:
    """Return the nodal vectors (steps, nodes, vectors, 2) of nodes with the section normal (c, s)."""
    count = len(kind.coordinates)
    vectors = kind.vectors(tuple(np.moveaxis(p[..., -count:], -1, 0)), c, s, frame[:, 2])
    components = np.concatenate([p[..., :-count], np.stack(vectors, axis=-1)], axis=-1)
    return components.reshape(*p.shape[:2], components.shape[-1] // 2, 2)  # no -1, which fails for zero steps


def across(vector: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2) rotated counter-clockwise by a right angle."""
    result = np.empty_like(vector)
    result[..., 0], result[..., 1] = -vector[..., 1], vector[..., 0]
    return result


def _rotated(x: np.ndarray, y: np.ndarray, frame: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the components of vectors (x, y) rotated by the reference angle of each node."""
    return frame[:, 0] * x - frame[:, 1] * y, frame[:, 1] * x + frame[:, 0] * y
