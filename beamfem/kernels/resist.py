"""Elastic forces of elements that are cut free, over the rows of a solution."""

from beamfem.kernels.assemble import add_element_forces, clear
from beamfem.kernels.compiling import kernel
from beamfem.kernels.reduce import place_nodes


@kernel(nogil=True)
def resist(form, block, p, v, a, nothing, e, acceleration, force):
    """Fill nodal vectors e, e'' and elastic forces (steps, N, per_node) of a block in states p, p', p'' (steps, n).

    nothing: (beams, 4) zeros, for what else acts on the elements.
    """
    for step in range(p.shape[0]):
        place_nodes(block, p[step], v[step], a[step], e[step], acceleration[step])
        clear(force[step])
        add_element_forces(form, block, e[step], acceleration[step], nothing, False, force[step])
