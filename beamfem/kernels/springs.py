"""Residual and tangent of springs of single coordinates to the ground."""

from beamfem.kernels.compiling import kernel


@kernel()
def assemble_springs(springs, p, ck, residual, matrix):
    """Add the forces k (p - rest) of springs to `residual` (n,), their stiffness to the diagonal of `matrix` (flat)."""
    for i in range(springs.dof.shape[0]):
        dof = springs.dof[i]
        residual[dof] += springs.stiffness[i] * (p[dof] - springs.rest[i])
        if matrix.shape[0] > 0 and springs.place[i] >= 0:
            matrix[springs.place[i]] += ck * springs.stiffness[i]
