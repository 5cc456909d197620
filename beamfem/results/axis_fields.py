"""Fields along the axes of beams, at points suited to plotting and export."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np

from beamfem.model.beam import Beam
from beamfem.results import postprocess
from beamfem.results.axis_points import AxisPoints
from beamfem.results.beam_stress import stress_at, stress_over_height
from beamfem.results.full_turns import rotation
from beamfem.results.postprocess import Components, Fields
from beamfem.results.section_forces import at_points
from beamfem.results.solution import Solution
from beamfem.results.stresses import stress_in_layer
from beamfem.validation import require_known, shown


def section_forces(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> dict[str, np.ndarray]:
    """Return normal and shear force [N] and moment [N m] (rows, points) of some rows of a solution, by name."""
    forces = at_points(solution, points, rows)
    return {name: forces[:, i] for i, name in enumerate(("normal", "shear", "moment"))}


Values = Callable[[AxisPoints, Solution, slice | np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Quantity:
    """A field along the axis: label for plots, unit, and values(points, solution, rows) -> (rows, points).

    unknown: what the model must define if the values are nan; over_height: the same, (rows, points, layers, heights)
    at `HEIGHTS` of each layer, of a field whose `values` are the extremes over them; None for others.
    """

    label: str
    unit: str
    values: Values
    unknown: str = ""
    over_height: Values | None = None

    def unknown_of(self, beams: Iterable[Beam]) -> str:
        """Return why it is not known of any of these beams."""
        laws = [beam.law for beam in beams]
        named = next((law.name for law in laws if law is not None), None)
        if named is None:
            return self.unknown
        why = f"the section law {named} tells resultants, but no stress"
        return why if all(laws) else f"{why}; besides, {self.unknown}"


def fields(points: AxisPoints, solution: Solution) -> Fields:
    """Return the fields at points over the steps; arrays (steps, points, ...)."""
    now, forces, height = points.now(solution.p), at_points(solution, points), np.zeros((len(points.xi), 1))
    along, sheared = (each[..., 0] for each in stress_in_layer(solution, points, None, height, forces))
    strain, stress = postprocess.strain_at_axis(points, now), Components(along, 0.0 * along, sheared)
    angle = rotation(points, solution)
    return Fields(now.r, now.r_s, now.d, angle, postprocess.shear_angle(now), strain, stress)


def _section_force(name: str, points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return section_forces(points, solution, rows)[name]


def _axial_strain(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return postprocess.strain_at_axis(points, points.now(solution.p[rows])).xx


def _shear_angle(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return postprocess.shear_angle(points.now(solution.p[rows]))


def _displacement(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(points.positions(solution.p[rows])[0] - points.reference, axis=-1))


def _speed(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(points.velocities(solution.p[rows], solution.v[rows]), axis=-1))


def _stress(name: str, points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    return stress_at(solution, points, rows)[name]


def _outer(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    stress = stress_at(solution, points, rows)
    return np.where(np.abs(stress["upper"]) >= np.abs(stress["lower"]), stress["upper"], stress["lower"])


def _over_height(
    name: Literal["von_mises", "utilisation"], points: AxisPoints, solution: Solution, rows: slice | np.ndarray
) -> np.ndarray:
    return stress_over_height(solution, points, rows, name)


_NO_STRESS = "stresses need sections with a material and a height"


def _of_stress(label: str, name: str) -> Quantity:
    return Quantity(label, "Pa", partial(_stress, name), _NO_STRESS)


_VON_MISES = replace(_of_stress("von Mises stress", "von_mises"), over_height=partial(_over_height, "von_mises"))
QUANTITIES = {
    "moment": Quantity("bending moment", "N m", partial(_section_force, "moment")),
    "normal": Quantity("normal force", "N", partial(_section_force, "normal")),
    "shear": Quantity("shear force", "N", partial(_section_force, "shear")),
    "stress": _VON_MISES,
    "von_mises": _VON_MISES,
    "upper": _of_stress("stress at the upper face", "upper"),
    "lower": _of_stress("stress at the lower face", "lower"),
    "outer": Quantity("stress at the outer fibre", "Pa", _outer, _NO_STRESS),
    "tension": _of_stress("largest tension", "tension"),
    "compression": _of_stress("largest compression", "compression"),
    "shear_stress": _of_stress("shear stress", "shear"),
    "utilisation": Quantity(
        "utilisation of the strength",
        "-",
        partial(_stress, "utilisation"),
        "give a material its strength, Material(..., strength=)",
        partial(_over_height, "utilisation"),
    ),
    "rotation": Quantity("rotation", "rad", rotation),
    "displacement": Quantity("displacement", "m", _displacement),
    "speed": Quantity("speed", "m/s", _speed),
    "axial_strain": Quantity("axial Green strain", "-", _axial_strain),
    "shear_angle": Quantity("shear angle", "rad", _shear_angle),
}


def quantity(name: str) -> Quantity:
    """Return a quantity by its name. Raises InputError."""
    require_known(f"there is no quantity {shown(name)} along a beam", name, QUANTITIES)
    return QUANTITIES[name]
