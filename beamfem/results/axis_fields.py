"""Fields along the axes of beams, and quantities of points, beams and models by their names."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.linalg import norm

from beamfem.errors import ConvergenceError
from beamfem.model.beam import Beam
from beamfem.results import postprocess
from beamfem.results.axis_points import AxisPoints
from beamfem.results.beam_stress import stress_at, stress_in_layer, stress_over_height
from beamfem.results.full_turns import rotation
from beamfem.results.postprocess import Components, Fields
from beamfem.results.section_forces import at_points
from beamfem.results.solution import Solution
from beamfem.validation import require_known, shown


def section_forces(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> dict[str, np.ndarray]:
    """Return normal and shear force [N] and moment [N m] (rows, points) of some rows of a solution, by name."""
    forces = at_points(solution, points, rows)
    return {name: forces[:, i] for i, name in enumerate(("normal", "shear", "moment"))}


Values = Callable[[AxisPoints, Solution, slice | np.ndarray], np.ndarray]
_SAME = 1e-9  # relative difference of the stresses of both faces that round-off makes


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


def _section_force(label: str, unit: str, number: int) -> Quantity:
    return Quantity(label, unit, lambda points, solution, rows: at_points(solution, points, rows)[:, number])


def _of_stress(label: str, name: str, unit: str = "Pa", unknown: str = "", over_height: bool = False) -> Quantity:
    """Return a stress by its name in `stress_at`; over_height: whether it is drawn over the section too."""
    return Quantity(
        label,
        unit,
        lambda points, solution, rows: stress_at(solution, points, rows)[name],
        unknown or "stresses need sections with a material and a height",
        (lambda points, solution, rows: stress_over_height(solution, points, rows, name)) if over_height else None,
    )


def _outer(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    stress = stress_at(solution, points, rows)
    # pure bending: round-off must not choose the face, and with it the sign
    below = np.abs(stress["lower"]) > (1.0 + _SAME) * np.abs(stress["upper"])
    return np.where(below, stress["lower"], stress["upper"])


def _error_share(points: AxisPoints, solution: Solution, rows: slice | np.ndarray) -> np.ndarray:
    result = []
    for row in np.arange(len(solution))[rows].tolist():
        try:
            shares = [solution.error_shares(mesh.beam, row) for mesh in points.mesh.parts]
        except ConvergenceError:
            shares = [np.full(points.mesh.elements, np.nan)]
        result.append(np.concatenate(shares)[points.element])
    return np.array(result)


_VON_MISES = _of_stress("von Mises stress", "von_mises", over_height=True)
_NO_STRENGTH = "give a material its strength, Material(..., strength=)"
QUANTITIES = {
    "moment": _section_force("bending moment", "N m", 2),
    "normal": _section_force("normal force", "N", 0),
    "shear": _section_force("shear force", "N", 1),
    "stress": _VON_MISES,
    "von_mises": _VON_MISES,
    "upper": _of_stress("stress at the upper face", "upper"),
    "lower": _of_stress("stress at the lower face", "lower"),
    "outer": replace(_of_stress("stress at the outer fibre", "upper"), values=_outer),
    "tension": _of_stress("largest tension", "tension"),
    "compression": _of_stress("largest compression", "compression"),
    "shear_stress": _of_stress("shear stress", "shear"),
    "utilisation": _of_stress("utilisation of the strength", "utilisation", "-", _NO_STRENGTH, over_height=True),
    "rotation": Quantity("rotation", "rad", rotation),
    "displacement": Quantity(
        "displacement",
        "m",
        lambda points, solution, rows: norm(points.positions(solution.p[rows])[0] - points.reference, axis=-1),
    ),
    "speed": Quantity(
        "speed",
        "m/s",
        lambda points, solution, rows: norm(points.velocities(solution.p[rows], solution.v[rows]), axis=-1),
    ),
    "axial_strain": Quantity(
        "axial Green strain",
        "-",
        lambda points, solution, rows: postprocess.strain_at_axis(points, points.now(solution.p[rows])).xx,
    ),
    "shear_angle": Quantity(
        "shear angle", "rad", lambda points, solution, rows: postprocess.shear_angle(points.now(solution.p[rows]))
    ),
    "error_share": Quantity(
        "share of an element in the error", "-", _error_share, "there is no equilibrium nearby on finer elements"
    ),
}


def quantity(name: str) -> Quantity:
    """Return a quantity by its name. Raises InputError."""
    require_known(f"there is no quantity {shown(name)} along a beam", name, QUANTITIES)
    return QUANTITIES[name]


# what a quantity is: the method of a Solution and the attributes or columns of its result; and the unit in SI
_AT_POINT = """
x position.0 m, y position.1 m, ux displacement.0 m, uy displacement.1 m, vx velocity.0 m/s, vy velocity.1 m/s,
ax acceleration.0 m/s^2, ay acceleration.1 m/s^2,
rotation rotation rad, fx reaction.0 N, fy reaction.1 N, m reaction.2 N_m, shear_angle fields.shear_angle rad,
strain_xx fields.green_strain.xx, strain_yy fields.green_strain.yy, strain_xy fields.green_strain.xy,
stress_xx fields.stress.xx Pa, stress_yy fields.stress.yy Pa, stress_xy fields.stress.xy Pa
"""
_OF_BEAM = """
normal section_forces.normal N, shear section_forces.shear N, moment section_forces.moment N_m,
lower stresses.lower Pa, upper stresses.upper Pa, tension stresses.tension Pa, compression stresses.compression Pa,
shear_stress stresses.shear Pa, von_mises stresses.von_mises Pa, utilisation stresses.utilisation
"""
_OF_MODEL = """
kinetic energy.kinetic J, strain energy.strain J, potential energy.potential J, total energy.total J,
dissipated energy.dissipated J, work energy.work J, px linear_momentum.0 N_s, py linear_momentum.1 N_s,
angular_momentum angular_momentum N_m_s, stable stable
"""
AT_POINT, OF_BEAM, OF_MODEL = (
    {name: what for name, *what in map(str.split, text.split(","))} for text in (_AT_POINT, _OF_BEAM, _OF_MODEL)
)
UNITS = {
    name: what[1].replace("_", " ") for name, what in {**AT_POINT, **OF_BEAM, **OF_MODEL}.items() if len(what) > 1
} | {"time": "s", "arc_length": "m", "frequencies": "Hz", "growth": "1/s"}


def value_of(solution: Solution, item: Any, what: str) -> np.ndarray:
    """Return a quantity of a point, a beam or the model in every state."""
    method, *parts = what.split(".")
    value: Any = getattr(solution, method)
    value = (value() if item is None else value(item)) if callable(value) else value
    for part in parts:
        value = value[:, int(part)] if part.isdigit() else getattr(value, part)
    return np.asarray(value)
