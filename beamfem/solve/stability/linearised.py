"""Critical load factors of the loading path linearised at its start."""

import numpy as np
from scipy.sparse import csr_array, eye_array
from scipy.sparse.linalg import LinearOperator, eigs

from beamfem.assembly.equations import STATICS, linearise
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.linalg.eigenpairs import MOST_RESTARTS, Pairs, first_that_works, first_vector, lanczos_vectors
from beamfem.linalg.lapack import eig, eigh, qr
from beamfem.linalg.repeated import repeated
from beamfem.linalg.tangent import UNROTATED, Factorised, Tangent
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes
from beamfem.solve.modes.pencil import is_symmetric

_CHANGE = 1e-3  # of the coordinates: step of the difference that gives the derivative of the tangent
_NONE = 1e-10  # of the rate of change of the coordinates: smaller rates are round-off
_INDEPENDENT = 1e-8
_SPARE = 2  # shapes found beyond those asked for


def linearised_loads(system: System, p: np.ndarray, load_factor: float, slope: np.ndarray, count: int) -> np.ndarray:
    """Return the `count` lowest critical lambda (m,) above a load factor of K0 phi = -(lambda - lambda0) K' phi.

    K0: tangent in the stable state p (n,); K' = dK/dlambda along slope = dp/dlambda (n,), a difference of fourth order.
    m < count if loads soften the model in fewer directions. Raises InputError if loads are not conservative.
    """
    moved = float(np.max(np.abs(slope) / system.scale))
    width = _CHANGE / moved
    tangent = _tangent(system, p, load_factor)
    stiffness = tangent.sparse(UNROTATED)
    rate = csr_array(stiffness.shape)
    for steps, weight in ((1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)):
        at = steps * width
        rate = rate + weight / (12.0 * width) * _tangent(system, p + at * slope, load_factor + at).sparse(UNROTATED)
    if not is_symmetric(system, csr_array(stiffness + width * rate)):
        raise InputError(
            "some load follows the beam, so that its work depends on the motion: such loads can make a structure "
            "flutter before its tangent is singular. Look at the growth of solve_modes(model, about=state) instead"
        )
    factors = tangent.factorised(system.rotated)
    shapes = _softened(csr_array(rate), factors, count, _NONE * moved)
    modes = np.zeros((shapes.shape[1], len(p)))
    modes[:, system.free_dofs] = shapes.T
    correction = np.zeros_like(p)
    zeros = np.zeros_like(p)
    unbalanced = linearise(system, p, zeros, zeros, load_factor, STATICS)[0]
    correction[system.free_dofs] = -factors.solve(unbalanced[system.free_dofs])
    rates = eigh(
        -shapes.T @ (rate @ shapes), stiffness_of_modes(system, p, load_factor, modes, correction), eigvals_only=True
    )[::-1]
    return np.asarray(load_factor + 1.0 / rates[rates > _NONE * moved][:count])


def _softened(rate: csr_array, factors: Factorised, count: int, none: float) -> np.ndarray:
    """Return a basis (unknown, m) of the shapes that lose the largest fraction of their stiffness per unit load.

    none: fraction that is round-off. The inverse of the tangent times -K' is not symmetric, but it contains no sums of
    large terms that cancel.
    """
    n = rate.shape[0]

    def lost(x: np.ndarray) -> np.ndarray:
        return -factors.solve(rate @ x)

    def search(basis: np.ndarray, wanted: int) -> Pairs:
        def besides(x: np.ndarray) -> np.ndarray:
            return lost(x - basis @ (basis.T @ x))

        def few(vectors: int) -> Pairs:
            operator = LinearOperator((n, n), matvec=besides, dtype=float)
            options = {"ncv": lanczos_vectors(vectors, wanted, n), "maxiter": MOST_RESTARTS, "v0": first_vector(n)}
            return eigs(operator, wanted, which="LR", **options)

        def dense() -> Pairs:
            return eig(np.column_stack([besides(column) for column in np.eye(n)]))

        return first_that_works(dense, few, n, wanted + 1)

    x = repeated(search, lost, csr_array(eye_array(n)), count + _SPARE, np.real, none)[1][:, : count + _SPARE + 1]
    # close eigenvalues may appear as a complex pair, whose real and imaginary parts span their shapes
    parts = np.column_stack([x.real, x.imag])
    basis, triangle, _ = qr(parts, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(triangle))
    return np.asarray(basis[:, sizes > _INDEPENDENT * sizes[0]])


def _tangent(system: System, p: np.ndarray, load_factor: float) -> Tangent:
    zeros = np.zeros_like(p)
    return linearise(system, p, zeros, zeros, load_factor, STATICS)[1]
