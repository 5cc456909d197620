"""Nodal coordinates: which numbers p carry the nodal vectors e of a field."""

from dataclasses import dataclass

import numpy as np

from beamfem.kernels.block import GRADIENTS, ROTATION


@dataclass(frozen=True)
class Gradients:
    """p = e: position vector gradients, constant mass; Omar and Shabana 2001."""

    name: str = "gradients"
    code: int = GRADIENTS

    def labels(self, vectors: tuple[str, ...]) -> tuple[str, ...]:
        """Names of a node's coordinates."""
        return tuple(f"{vector}^{axis}" for vector in vectors for axis in "xy")

    def columns(self, vectors: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
        """First component of e, and one past the last, that each coordinate of a node moves."""
        start = np.arange(2 * len(vectors))
        return start, start + 1


@dataclass(frozen=True)
class Rotation:
    """r_y = (-sin t, cos t), t relative to the reference; paper, eqs. (5) to (7), (11), (12)."""

    name: str = "rotation"
    code: int = ROTATION

    def labels(self, vectors: tuple[str, ...]) -> tuple[str, ...]:
        """Names of a node's coordinates; r_y comes last in every field."""
        return (*Gradients().labels(vectors[:-1]), "theta")

    def columns(self, vectors: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray]:
        """First component of e, and one past the last, that each coordinate of a node moves."""
        start = np.arange(2 * len(vectors) - 1)
        stop = start + 1
        stop[-1] += 1
        return start, stop
