"""Displacements and rotations of points, linear in small changes of the coordinates."""

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beamfem.element.fields import cross, dot
from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.nodal import axis_at, rate_at
from beamfem.validation import require_known, shown

Quantity = tuple[str, Point]
QUANTITIES = {"ux": ("displacement ux", "m"), "uy": ("displacement uy", "m"), "rotation": ("rotation", "rad")}


def output_row(model: Model, p: np.ndarray, quantity: Any) -> csr_array:
    """Return the derivative (1, n) of a quantity such as ("uy", beam.end) by the coordinates in a state p (n,).

    Raises InputError for anything else, UnknownPointError for a point of another model.
    """
    if not (isinstance(quantity, tuple) and len(quantity) == 2 and isinstance(quantity[1], Point)):
        raise InputError(f'a quantity is a pair of a name and a point, such as ("uy", beam.end), got {shown(quantity)}')
    name, point = quantity
    require_known(f"{shown(name)} is no quantity of a linear model", name, QUANTITIES)
    mesh = model.mesh_of(point)
    element, xi = (np.array([place]) for place in mesh.locate(point.fraction))
    dofs = np.unique(mesh.kinematics.dof[mesh.node[element[0]]])
    dofs = dofs[dofs >= 0]
    rates = np.zeros((len(dofs), len(p)))
    rates[np.arange(len(dofs)), dofs] = 1.0
    rate = rate_at(mesh, np.broadcast_to(p, rates.shape), rates, element, xi)
    if name == "rotation":
        now = axis_at(mesh, p[None], element, xi)
        by_slope = mesh.beam.element.forces.turns_with == "r_x"
        direction, turning = (now.r_s, rate.r_s) if by_slope else (now.d, rate.d)
        values = (cross(direction, turning) / dot(direction, direction))[:, 0]
    else:
        values = rate.r[:, 0, "xy".index(name[1])]
    return csr_array((values, (np.zeros(len(dofs), dtype=np.int64), dofs)), shape=(1, len(p)))
