"""Points of a model as text."""

from collections.abc import Sequence

import numpy as np

from beamfem.model.model import Model

_NOTHING = 1e-9  # of the model's size: round-off of a zero


def place(model: Model, at: Sequence[float] | np.ndarray) -> str:
    """Return a point (2,) [m] to four digits, without the round-off of a zero."""
    corners = np.array([end(mesh.position, axis=0) for mesh in model.meshes for end in (np.min, np.max)])
    size = max(float(np.ptp(corners, axis=0).max()), float(np.abs(at).max()))
    x, y = (0.0 if abs(value) <= _NOTHING * size else value for value in at)
    return f"({x:.4g}, {y:.4g})"
