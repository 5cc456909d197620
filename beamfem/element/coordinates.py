"""Nodal coordinates: which numbers p carry the nodal vectors e of a field."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.kernels.block import GRADIENTS, ROTATION, SHEAR_RIGID, STRETCH, TURNED_GRADIENTS
from beamfem.validation import flag


@dataclass(frozen=True)
class Gradients:
    """p = e: position vector gradients, constant mass; Omar and Shabana 2001."""

    name: ClassVar[str] = "gradients"
    code: ClassVar[int] = GRADIENTS


@dataclass(frozen=True)
class Rotation:
    """r_y = (-sin t, cos t), t relative to the reference; paper, eqs. (5) to (7), (11), (12)."""

    name: ClassVar[str] = "rotation"
    code: ClassVar[int] = ROTATION


@dataclass(frozen=True)
class ShearFree:
    """r_x = s (cos t, sin t), r_y = (-sin t, cos t): no shear at the nodes; paper, sections 1.5 and 3.5.

    stretchable: whether s is a coordinate; otherwise it stays as in the reference (1 by arc length). Needs a field that
    has r_x.
    """

    stretchable: bool = True

    def __post_init__(self) -> None:
        flag("stretchable", self.stretchable)

    @property
    def name(self) -> str:
        return "stretch" if self.stretchable else "shear-rigid"

    @property
    def code(self) -> int:
        return STRETCH if self.stretchable else SHEAR_RIGID


Coordinates = Gradients | Rotation | ShearFree


def labels(carrier: int, vectors: tuple[str, ...]) -> tuple[str, ...]:
    """Names of a node's coordinates: those of nodal vectors, the stretch "s", the angle "theta"; r_y comes last."""
    if carrier in (STRETCH, SHEAR_RIGID):
        return ("r^x", "r^y", *(("s",) if carrier == STRETCH else ()), "theta")
    components = tuple(f"{vector}^{axis}" for vector in vectors for axis in "xy")
    return (*components[:-2], "theta") if carrier == ROTATION else components


def nodal_vectors(carrier: int, vectors: tuple[str, ...], p: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """Return e (steps, nodes, vectors, 2) of coordinates p (steps, nodes, npn); frame (nodes, 3), see `node_map`."""
    result = np.empty((*p.shape[:2], len(vectors), 2))
    names = labels(carrier, vectors)
    turn = _turned(p[..., len(names) - 1], frame) if names[-1] == "theta" else None
    for i, vector in enumerate(vectors):
        if f"{vector}^x" in names:
            first = names.index(f"{vector}^x")
            result[:, :, i] = p[:, :, first : first + 2]
        elif turn is not None:
            size = p[..., 2, None] if "s" in names else frame[:, 2, None]
            result[:, :, i] = across(turn) if vector == "r_y" else size * turn
    if carrier == TURNED_GRADIENTS:
        x, y = result[:, :, -1, 0].copy(), result[:, :, -1, 1].copy()
        result[:, :, -1, 0] = frame[:, 0] * x - frame[:, 1] * y
        result[:, :, -1, 1] = frame[:, 1] * x + frame[:, 0] * y
    return result


def nodal_rates(carrier: int, vectors: tuple[str, ...], p: np.ndarray, v: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """Return e' = B p' (steps, nodes, vectors, 2) of p and p' (steps, nodes, npn)."""
    names = labels(carrier, vectors)
    if names[-1] != "theta":
        return nodal_vectors(carrier, vectors, v, frame)
    result = nodal_vectors(carrier, vectors, p, frame)
    spin = v[..., len(names) - 1, None]
    for i, vector in enumerate(vectors):
        if f"{vector}^x" in names:
            first = names.index(f"{vector}^x")
            result[:, :, i] = v[:, :, first : first + 2]
        else:
            result[:, :, i] = spin * across(result[:, :, i])
            if vector == "r_x" and "s" in names:
                result[:, :, i] += v[..., 2, None] * _turned(p[..., len(names) - 1], frame)
    return result


def across(vector: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2) turned by a right angle, counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def _turned(angle: np.ndarray, frame: np.ndarray) -> np.ndarray:
    """Unit vectors (..., 2) along the reference angle plus `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * frame[:, 0] - s * frame[:, 1], s * frame[:, 0] + c * frame[:, 1]], axis=-1)
