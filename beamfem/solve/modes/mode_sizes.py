"""Sizes of mode shapes, whatever the coordinates are."""

import numpy as np

from beamfem.model.model import Model
from beamfem.results.postprocess import nodal_vectors, nodal_velocities


def nodal_motion(model: Model, p: np.ndarray, shape: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return for each beam the nodes' positions and, per unit of a real shape (n,), their displacements (nodes, 2)."""
    result = []
    for mesh in model.meshes:
        slot = mesh.beam.element.field.vectors.index("r")
        positions = nodal_vectors(mesh, p[None])[0, :, slot]
        result.append((positions, nodal_velocities(mesh, p[None], shape[None])[0, :, slot]))
    return result


def largest_translation(model: Model, p: np.ndarray, shape: np.ndarray) -> float:
    """Return the largest displacement of a node in a shape (n,), real or complex; where no node moves, 1 rad counts."""
    parts = [np.concatenate([u for _, u in nodal_motion(model, p, part)]) for part in (shape.real, shape.imag)]
    moved = float(np.hypot(*(np.linalg.norm(part, axis=1) for part in parts)).max())
    largest = float(np.abs(shape).max())
    return moved if moved > 1e-9 * largest else largest


def upright(shapes: np.ndarray) -> np.ndarray:
    """Return shapes (m, n) each with its largest entry positive, real where shapes are complex."""
    if shapes.size == 0:
        return shapes
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
    return np.asarray(shapes * (np.conj(largest) / np.abs(largest)))
