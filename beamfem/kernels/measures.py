"""Strain measures at one point of the beam axis, their stress resultants and what these give; all in scalars.

A measure is a function eps(r, d, e) of r = r0', d and e, which is d', or r0'' for the elastic line; it is written once
readable in `beamfem.element.forces`. All take six measures, of which some kinds use four.
"""

from beamfem.kernels import elastic_line, green_lagrange, structural
from beamfem.kernels.block import GREEN_LAGRANGE, STRUCTURAL
from beamfem.kernels.compiling import kernel

FAST = {"contract", "reassoc", "nsz"}

_green_strains, _green_forces = green_lagrange.strains, green_lagrange.forces
_green_rates, _green_hessian = green_lagrange.rates, green_lagrange.hessian
_structural_strains, _structural_forces = structural.strains, structural.forces
_structural_rates, _structural_hessian = structural.rates, structural.hessian
_line_strains, _line_forces = elastic_line.strains, elastic_line.forces
_line_rates, _line_hessian = elastic_line.rates, elastic_line.hessian


@kernel(forceinline=True)
def strains(measures, q):
    """Return eps (6) of the kind that a block asks for."""
    if measures == GREEN_LAGRANGE:
        return _green_strains(q)
    if measures == STRUCTURAL:
        return _structural_strains(q)
    return _line_strains(q)


@kernel(forceinline=True)
def rates(measures, q, dq):
    """Return the change of eps (6) with changes dq of q = (r, d, e)."""
    if measures == GREEN_LAGRANGE:
        return _green_rates(q, dq)
    if measures == STRUCTURAL:
        return _structural_rates(q, dq)
    return _line_rates(q, dq)


@kernel(forceinline=True, fastmath=FAST)
def resultants(measures, w, c, reference, k, g, eps):
    """Return w c (eps - reference) (6) of class k and point g; c (nc, nq, ns, ns), reference (nc, nq, ns)."""
    a0, a1 = eps[0] - reference[k, g, 0], eps[1] - reference[k, g, 1]
    a2, a3 = eps[2] - reference[k, g, 2], eps[3] - reference[k, g, 3]
    s0 = c[k, g, 0, 0] * a0 + c[k, g, 0, 1] * a1 + c[k, g, 0, 2] * a2 + c[k, g, 0, 3] * a3
    s1 = c[k, g, 1, 0] * a0 + c[k, g, 1, 1] * a1 + c[k, g, 1, 2] * a2 + c[k, g, 1, 3] * a3
    s2 = c[k, g, 2, 0] * a0 + c[k, g, 2, 1] * a1 + c[k, g, 2, 2] * a2 + c[k, g, 2, 3] * a3
    s3 = c[k, g, 3, 0] * a0 + c[k, g, 3, 1] * a1 + c[k, g, 3, 2] * a2 + c[k, g, 3, 3] * a3
    if measures != GREEN_LAGRANGE:
        return w * s0, w * s1, w * s2, w * s3, 0.0, 0.0
    a4, a5 = eps[4] - reference[k, g, 4], eps[5] - reference[k, g, 5]
    s4 = (
        c[k, g, 4, 0] * a0
        + c[k, g, 4, 1] * a1
        + c[k, g, 4, 2] * a2
        + c[k, g, 4, 3] * a3
        + c[k, g, 4, 4] * a4
        + c[k, g, 4, 5] * a5
    )
    s5 = (
        c[k, g, 5, 0] * a0
        + c[k, g, 5, 1] * a1
        + c[k, g, 5, 2] * a2
        + c[k, g, 5, 3] * a3
        + c[k, g, 5, 4] * a4
        + c[k, g, 5, 5] * a5
    )
    return (
        w * (s0 + c[k, g, 0, 4] * a4 + c[k, g, 0, 5] * a5),
        w * (s1 + c[k, g, 1, 4] * a4 + c[k, g, 1, 5] * a5),
        w * (s2 + c[k, g, 2, 4] * a4 + c[k, g, 2, 5] * a5),
        w * (s3 + c[k, g, 3, 4] * a4 + c[k, g, 3, 5] * a5),
        w * s4,
        w * s5,
    )


@kernel(forceinline=True)
def forces(measures, q, s):
    """Return the vectors on r, d and e of stress resultants s (6)."""
    if measures == GREEN_LAGRANGE:
        return _green_forces(q, s)
    if measures == STRUCTURAL:
        return _structural_forces(q, s)
    return _line_forces(q, s)


@kernel(forceinline=True)
def hessian(measures, q, c, k, g, w, s):
    """Return the blocks rr (3), rd, re (4 each), dd (3), de (4), ee (3) of w grad^T c grad + sum_i s_i d2 eps_i."""
    if measures == GREEN_LAGRANGE:
        return _green_hessian(q, c, k, g, w, s)
    if measures == STRUCTURAL:
        return _structural_hessian(q, c, k, g, w, s)
    return _line_hessian(q, c, k, g, w, s)
