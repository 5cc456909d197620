"""Reduction to coordinates, e' = B p': forces B^T f, matrices B^T k B, and their addition to a sparse matrix.

The coordinates of a node are its first components of nodal vectors, followed by those on which the last `dependent`
components depend: B = diag(1, b) with b (dependent, parameters) for each node. Coordinates that a node lacks are
numbered -1.
"""

from beamfem.kernels.compiling import FAST, inlined, routine
from beamfem.kernels.element_stiffness import multiply
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Reals
from beamfem.kernels.simd import WIDTH, as_rows


@routine("iiiiiivvv", fastmath=FAST)
def reduce_rows(nodes, size, dependent, parameters, count, stride, b, k, space):
    """Replace k B (columns, rows, ROW) by B^T k B.

    size: components of a node; b (nodes, stride, ROW); space (parameters, ROW): workspace.
    """
    rows, linear = nodes * size, size - dependent
    for m in range(nodes):
        for column in range(linear + parameters):
            for n in range(nodes):
                entries = at(k, (rows * (m * size + column) + n * size + linear) * ROW)
                multiply(dependent, parameters, count, at(b, n * stride * ROW), 1, entries, space)
                for row in range(parameters):
                    source, to = at(space, row * ROW), at(entries, row * ROW)
                    for i in range(0, count, WIDTH):
                        to[i] = source[i]


@routine("iiiinsrr")
def add_to_sparse(nodes, size, coordinates, count, elements, slots, k, matrix):
    """Add the reduced matrices k of a batch to the data of a sparse matrix.

    slots (elements, nodes * coordinates, nodes * coordinates): positions in the data, -1 for prescribed coordinates.
    """
    rows, per = nodes * size, nodes * coordinates
    for i in range(count):
        table = at(slots, elements[i] * per * per)
        for n in range(nodes):
            for row_dof in range(coordinates):
                for m in range(nodes):
                    for column_dof in range(coordinates):
                        slot = table[(n * coordinates + row_dof) * per + m * coordinates + column_dof]
                        if slot >= 0:
                            matrix[slot] += k[(rows * (m * size + column_dof) + n * size + row_dof) * ROW + i]


@inlined
def add_node_forces(first, count, size, dependent, parameters, stride, dof, rows, force, chunk, space, residual):
    """Add B^T f of the nodes of a chunk to the residual (n,).

    dof (coordinates, stride); rows, force: first rows of b and f in the chunk; space (ROW,): workspace.
    """
    linear = size - dependent
    for row in range(linear):
        dofs, source = at(dof, row * stride + first), at(chunk, (force + row) * ROW)
        for i in range(count):
            residual[dofs[i]] += source[i]
    b, f, sums = as_rows(at(chunk, rows * ROW)), as_rows(at(chunk, (force + linear) * ROW)), as_rows(space)
    for column in range(parameters):
        dofs = at(dof, (linear + column) * stride + first)
        for i in range(0, count, WIDTH):
            total = b[column * ROW + i] * f[i]
            for part in range(1, dependent):
                total += b[(part * parameters + column) * ROW + i] * f[part * ROW + i]
            sums[i] = total
        for i in range(count):
            if dofs[i] >= 0:
                residual[dofs[i]] += space[i]


@routine()
def add_curvature(
    group: Group, system: System, first: int, count: int, linear: int, parameters: int, chunk: Reals
) -> None:
    """Add ck times the derivative of B^T f at constant f (parameters, parameters) of nodes to the matrix.

    chunk: from the lane of the first of these nodes on; linear: coordinates of a node before those on which B depends.
    """
    coordinates, stride, row, dof = group.coordinates, group.nodes, group.curvature, group.dof
    free, home, half, slots = group.free, group.home, group.half_width, group.slot
    matrix, factor, per = system.matrix, system.weight_p, group.nodes_per_element * coordinates
    for j in range(parameters):
        for k in range(parameters):
            value = at(chunk, (row + j * parameters + k) * ROW)
            row_dofs, column_dofs = at(dof, (linear + j) * stride + first), at(dof, (linear + k) * stride + first)
            for i in range(count):
                matrix_row, matrix_column = free[row_dofs[i]], free[column_dofs[i]]
                if matrix_row < 0 or matrix_column < 0:
                    continue
                if half >= 0:
                    matrix[2 * half * matrix_row + half + matrix_column] += factor * value[i]
                else:
                    element, begin = home[2 * (first + i)], home[2 * (first + i) + 1] * coordinates + linear
                    matrix[slots[(element * per + begin + j) * per + begin + k]] += factor * value[i]
