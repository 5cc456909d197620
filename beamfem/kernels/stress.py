"""Stress resultants at the quadrature points that a linearised step predicts."""

from beamfem.kernels.axis import interpolate
from beamfem.kernels.block import ELASTIC_LINE
from beamfem.kernels.compiling import kernel
from beamfem.kernels.coordinates import node_rates
from beamfem.kernels.form import sizes
from beamfem.kernels.measures import rates, resultants, strains
from beamfem.kernels.reduce import place_nodes


@kernel(nogil=True)
def predict_stress(form, block, work, p, step, stress):
    """Fill stress (ne, nq, ns) with C (eps + (d eps / de) B dp), B and eps at p, dp = step.

    The independent stresses of Magisano, Leonetti and Garcea 2017 for the geometric part
    of the tangent.
    """
    nn, vpn, measures = sizes(form, block)
    bends = measures == ELASTIC_LINE
    e, de = work.nodes[0], work.nodes[1]
    place_nodes(block, p, step, step, e, de)
    for node in range(block.dof.shape[0]):
        node_rates(block, node, e, step, de)
    for element in range(block.node.shape[0]):
        kind = block.kind[element]
        for point in range(block.weight.shape[1]):
            q = interpolate(nn, vpn, bends, block, element, kind, point, e)
            dq = interpolate(nn, vpn, bends, block, element, kind, point, de)
            a, b = strains(measures, q), rates(measures, q, dq)
            after = (a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5])
            s = resultants(measures, 1.0, block.stiffness, block.reference, kind, point, after)
            for i in range(stress.shape[2]):
                stress[element, point, i] = s[i]
