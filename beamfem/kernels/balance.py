"""Residual and tangent of a whole model: elements, loads at points and springs of all blocks."""

from beamfem.kernels.assemble import assemble
from beamfem.kernels.axis import interpolate
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.compiling import kernel
from beamfem.kernels.form import sizes
from beamfem.kernels.loads import assemble_point_loads
from beamfem.kernels.springs import assemble_springs


@kernel(nogil=True, forceinline=True)
def balance(
    forms, blocks, work, loads, springs, layouts, p, v, a, body, values, row, coefficients, predicted, residual, matrix
):
    """Fill the residual (n,) and, unless it is empty, the flat matrix; see `assemble`.

    values: of each block (rows, nl, 3), of which one row acts. predicted: take the geometric part of the tangent from
    the stresses in `work`.
    """
    for i in range(residual.shape[0]):
        residual[i] = 0.0
    for i in range(matrix.shape[0]):
        matrix[i] = 0.0
    ck = coefficients[0]
    for i in range(len(blocks)):
        stress = work[i].stress if predicted else work[i].stress[:0]
        assemble(forms[i], blocks[i], layouts[i], work[i], p, v, a, body, coefficients, stress, residual, matrix)
        if loads[i].element.shape[0] > 0:
            assemble_point_loads(blocks[i], loads[i], layouts[i], work[i], values[i][row], ck, residual, matrix)
    if springs.dof.shape[0] > 0:
        assemble_springs(springs, p, ck, residual, matrix)


@kernel(nogil=True)
def smallest_jacobian(forms, blocks, work):
    """Return the smallest r0' x d of all quadrature points, at the nodal vectors in `work`; negative inside out."""
    smallest = 1.0
    for i in range(len(blocks)):
        block, e = blocks[i], work[i].nodes[0]
        nn, vpn, measures = sizes(forms[i], block)
        for element in range(block.node.shape[0]):
            for point in range(block.weight.shape[1]):
                q = interpolate(nn, vpn, measures == ELASTIC_LINE, block, element, block.kind[element], point, e)
                smallest = min(smallest, q[0] * q[3] - q[1] * q[2])
    return smallest
