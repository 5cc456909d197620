"""Quantities of a point, a beam or a model by their names, for outputs of model files and for curves."""

from typing import Any

import numpy as np

from beamfem.results.solution import Solution

# what a quantity is: the method of a Solution and the attributes or columns of its result; and the unit in SI
_AT_POINT = """
x position.0 m, y position.1 m, ux displacement.0 m, uy displacement.1 m, vx velocity.0 m/s, vy velocity.1 m/s,
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
