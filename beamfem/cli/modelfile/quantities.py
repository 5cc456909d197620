"""Quantities that a model file can request, each a function of a solution and of a point, beam or connector."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from beamfem.results.solution import Solution

Quantities = Mapping[str, Callable[[Solution, Any], np.ndarray]]

# of a point, for curves too: method of a Solution and component of what it returns
QUANTITIES = {
    "x": ("position", 0),
    "y": ("position", 1),
    "ux": ("displacement", 0),
    "uy": ("displacement", 1),
    "vx": ("velocity", 0),
    "vy": ("velocity", 1),
    "rotation": ("rotation", None),
    "fx": ("reaction", 0),
    "fy": ("reaction", 1),
    "m": ("reaction", 2),
}


# in SI, of quantities and of what tables print beside them; what is not here has none
UNITS = {
    **dict.fromkeys(("x", "y", "ux", "uy", "arc_length"), "m"),
    **dict.fromkeys(("vx", "vy"), "m/s"),
    **dict.fromkeys(("rotation", "shear_angle"), "rad"),
    **dict.fromkeys(("fx", "fy", "normal", "shear"), "N"),
    **dict.fromkeys(("m", "moment"), "N m"),
    **dict.fromkeys(("stress_xx", "stress_yy", "stress_xy", "shear_stress"), "Pa"),
    **dict.fromkeys(("lower", "upper", "tension", "compression", "von_mises"), "Pa"),
    **dict.fromkeys(("kinetic", "strain", "potential", "total"), "J"),
    **dict.fromkeys(("px", "py"), "N s"),
    "angular_momentum": "N m s",
    "time": "s",
}


def _at_point(method: str, component: int | None, solution: Solution, point: Any) -> np.ndarray:
    values: np.ndarray = getattr(solution, method)(point)
    return values if component is None else values[:, component]


def _component(field: str, component: str, solution: Solution, point: Any) -> np.ndarray:
    values: np.ndarray = getattr(getattr(solution.fields(point), field), component)
    return values


def _force(name: str, solution: Solution, beam: Any) -> np.ndarray:
    values: np.ndarray = getattr(solution.section_forces(beam), name)
    return values


def _stress(name: str, solution: Solution, beam: Any) -> np.ndarray:
    values: np.ndarray = getattr(solution.stresses(beam), name)
    return values


def _energy(name: str, solution: Solution, _: Any) -> np.ndarray:
    values: np.ndarray = getattr(solution.energy(), name)
    return values


def _connector_force(part: int, solution: Solution, connector: Any) -> np.ndarray:
    values: np.ndarray = solution.connector_force(connector)[..., part]
    return values


AT_POINT: Quantities = {
    **{name: partial(_at_point, *how) for name, how in QUANTITIES.items()},
    "shear_angle": lambda solution, point: solution.fields(point).shear_angle,
    **{f"strain_{part}": partial(_component, "green_strain", part) for part in ("xx", "yy", "xy")},
    **{f"stress_{part}": partial(_component, "stress", part) for part in ("xx", "yy", "xy")},
}
OF_BEAM: Quantities = {
    **{name: partial(_force, name) for name in ("normal", "shear", "moment")},
    **{name: partial(_stress, name) for name in ("lower", "upper", "tension", "compression", "von_mises")},
    "shear_stress": partial(_stress, "shear"),
    "utilisation": partial(_stress, "utilisation"),
}
OF_CONNECTOR: Quantities = {
    **{name: partial(_connector_force, part) for part, name in enumerate(("fx", "fy", "m"))},
    "multiplier": lambda solution, connector: solution.multipliers(connector),
}
OF_MODEL: Quantities = {
    **{name: partial(_energy, name) for name in ("kinetic", "strain", "potential", "total", "dissipated")},
    "px": lambda solution, _: solution.linear_momentum()[:, 0],
    "py": lambda solution, _: solution.linear_momentum()[:, 1],
    "angular_momentum": lambda solution, _: solution.angular_momentum(),
    "stable": lambda solution, _: solution.stable,
}
