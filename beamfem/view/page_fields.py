"""Fields of the rows of a page, in levels between their limits."""

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from beamfem.model.joined_mesh import join
from beamfem.results.axis_fields import QUANTITIES, AxisPoints, section_forces
from beamfem.results.batched_beams import of_each
from beamfem.results.beam_stress import stress_at
from beamfem.results.solution import Solution
from beamfem.view.deformed_shapes import Shapes, limits

_FORCES = ("moment", "normal", "shear")
# names of fields and of the parts of `BeamStress`
_STRESSES = {"stress": "von_mises", "upper": "upper", "lower": "lower", "utilisation": "utilisation"}
FURTHER = ("upper", "lower", "utilisation")  # only on pages with room for them
_LEVELS = 254.0  # steps between the limits; level 0 is what is not known


def names_of(solution: Solution) -> tuple[str, ...]:
    """Return the names of the fields of a page: stresses where a section has some."""
    known = set()
    model = solution.model
    for numbers in model.numbered.joinable:
        mesh = join([model.meshes[number] for number in numbers])
        starts = np.arange(mesh.elements)
        stress = stress_at(solution, mesh, starts, np.zeros(mesh.elements), slice(len(solution) - 1, len(solution)))
        known |= {name for name, part in _STRESSES.items() if np.isfinite(stress[part]).any()}
    stresses = tuple(name for name in _STRESSES if name in known)
    moved = ("rotation", "displacement") if solution.static else ("rotation", "displacement", "speed")
    return (*_FORCES, *stresses, *moved)


def fields_of(shapes: Shapes, names: Sequence[str]) -> list[dict[str, Any]]:
    """Return fields by name in levels from 1 to 255 between their limits, 0 where they are not known."""
    solution, rows = shapes.solution, shapes.rows
    by_beam = of_each(shapes.groups, lambda points: _along(points, solution, rows, names), 2)
    result = []
    for number, name in enumerate(names):
        quantity, parts = QUANTITIES[name], [values[number] for values in by_beam]
        low, high = limits(parts)
        values = np.concatenate(parts, axis=1)
        known = np.isfinite(values)
        levels = np.where(known, 1.0 + np.round((np.where(known, values, low) - low) / (high - low) * _LEVELS), 0.0)
        whole = "" if quantity.over_height is None else ", largest over the height"  # a page has one colour a section
        label = f"{quantity.label}{whole} [{solution.model.unit(quantity.unit)}]"
        result.append({"name": name, "label": label, "low": low, "high": high, "values": as_text(levels.astype("u1"))})
    return result


def _along(points: AxisPoints, solution: Solution, rows: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Return fields (names, rows, points)."""
    result = section_forces(points, solution, rows)
    if any(name in _STRESSES for name in names):
        stress = stress_at(solution, points.mesh, points.element, points.xi, rows)
        result |= {name: stress[part] for name, part in _STRESSES.items()}
    result |= {name: QUANTITIES[name].values(points, solution, rows) for name in names if name not in result}
    return np.stack([result[name] for name in names])


def as_text(numbers: np.ndarray) -> str:
    """Return numbers as text for a page."""
    return base64.b64encode(np.ascontiguousarray(numbers).tobytes()).decode()
