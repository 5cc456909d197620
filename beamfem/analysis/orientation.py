"""Whether a state has turned some part of a beam inside out."""

import numpy as np

from beamfem.element import coordinates
from beamfem.element.axis import cross
from beamfem.element.element import Element
from beamfem.element.fields import d_slots, r_slots
from beamfem.kernels.block import Block
from beamfem.model.system import System


def inverted(system: System, p: np.ndarray) -> bool:
    """Tell whether r0' x d is negative at some Gauss point; elastic forces that are polynomials do not prevent it."""
    return any(_inverted(element, block, p) for element, block in zip(system.model.groups, system.blocks, strict=True))


def _inverted(element: Element, block: Block, p: np.ndarray) -> bool:
    field = element.field
    xi, _ = element.quadrature()
    vectors = _nodal_vectors(field.vectors, block, p)
    r_slope = block.scale[block.kind][:, block.r_slots, None] * vectors[:, r_slots(field)]
    slope = np.einsum("qi,eic->eqc", field.centreline(xi, 1), r_slope)
    d = np.einsum("qi,eic->eqc", field.director(xi), vectors[:, d_slots(field)])
    return bool(np.any(cross(slope, d) <= 0.0))


def _nodal_vectors(names: tuple[str, ...], block: Block, p: np.ndarray) -> np.ndarray:
    """Return the nodal vectors e (ne, nv, 2) of all elements in a state p (n,)."""
    elements, nodes = block.carrier.shape
    carrier, frame = block.carrier.ravel(), block.frame.reshape(-1, 3)
    table = p[block.dof.reshape(elements * nodes, -1)][None]
    result = np.empty((elements * nodes, len(names), 2))
    for code in np.unique(carrier):
        here = carrier == code
        result[here] = coordinates.nodal_vectors(int(code), names, table[:, here], frame[here])[0]
    return result.reshape(elements, -1, 2)
