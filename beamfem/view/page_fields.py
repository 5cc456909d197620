"""Fields of the rows of a page, in levels between their limits."""

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from beamfem.results.along import QUANTITIES, section_forces
from beamfem.results.beam_stress import stress_at
from beamfem.results.solution import Solution
from beamfem.view.shapes import Shapes, limits

_FORCES = ("moment", "normal", "shear")
# names of fields and of the parts of `BeamStress`
_STRESSES = {"stress": "von_mises", "upper": "upper", "lower": "lower", "utilisation": "utilisation"}
FURTHER = ("upper", "lower", "utilisation")  # only on pages with room for them
_LEVELS = 254.0  # steps between the limits; level 0 is what is not known


def names_of(solution: Solution) -> tuple[str, ...]:
    """Return the names of the fields of a page: stresses where a section has some."""
    known = set()
    for mesh in solution.model.meshes:
        starts = np.arange(mesh.elements)
        stress = stress_at(solution, mesh, starts, np.zeros(mesh.elements), slice(len(solution) - 1, len(solution)))
        known |= {name for name, part in _STRESSES.items() if np.isfinite(stress[part]).any()}
    stresses = tuple(name for name in _STRESSES if name in known)
    moved = ("rotation", "displacement") if solution.static else ("rotation", "displacement", "speed")
    return (*_FORCES, *stresses, *moved)


def fields_of(shapes: Shapes, names: Sequence[str]) -> list[dict[str, Any]]:
    """Return fields by name in levels from 1 to 255 between their limits, 0 where they are not known."""
    solution, rows = shapes.solution, shapes.rows
    forces = [section_forces(points, solution, rows) for points in shapes.points]
    stresses: list[dict[str, np.ndarray]] = []
    if any(name in _STRESSES for name in names):
        stresses = [stress_at(solution, of_beam.mesh, of_beam.element, of_beam.xi, rows) for of_beam in shapes.points]
    result = []
    for name in names:
        quantity = QUANTITIES[name]
        if name in _FORCES:
            parts = [of_beam[name] for of_beam in forces]
        elif name in _STRESSES:
            parts = [of_beam[_STRESSES[name]] for of_beam in stresses]
        else:
            parts = [quantity.values(points, solution, rows) for points in shapes.points]
        low, high = limits(parts)
        values = np.concatenate(parts, axis=1)
        known = np.isfinite(values)
        levels = np.where(known, 1.0 + np.round((np.where(known, values, low) - low) / (high - low) * _LEVELS), 0.0)
        label = f"{quantity.label} [{solution.model.unit(quantity.unit)}]"
        result.append({"name": name, "label": label, "low": low, "high": high, "values": as_text(levels.astype("u1"))})
    return result


def as_text(numbers: np.ndarray) -> str:
    """Return numbers as text for a page."""
    return base64.b64encode(np.ascontiguousarray(numbers).tobytes()).decode()
