"""Critical load factors of linear buckling analysis: the geometric stiffness of the linear solution grows."""

import numpy as np
from scipy.sparse import csr_array, eye_array
from scipy.sparse.linalg import LinearOperator, eigs

from beamfem.assembly.equations import residual
from beamfem.assembly.system import System
from beamfem.errors import InputError
from beamfem.linalg.eigenpairs import MOST_RESTARTS, Pairs, first_that_works, first_vector, lanczos_vectors
from beamfem.linalg.lapack import eig, eigh, qr
from beamfem.linalg.repeated import repeated
from beamfem.linalg.tangent import Factorised
from beamfem.solve.modes.mode_stiffness import stiffness_of_modes
from beamfem.solve.modes.pencil import is_symmetric
from beamfem.solve.stability.linear_solution import LinearSolution
from beamfem.solve.stability.model_size import largest_movement

_CHANGE = 1e-3  # of the stiffness: effect of loads whose symmetry is judged
_NONE = 1e-10  # of the effect of the loads on the stiffness: smaller fractions of it are round-off
_INDEPENDENT = 1e-8
_SPARE = 2  # shapes found beyond those asked for
_STRAIN = 0.2  # of the linear solution, which means nothing beyond
_MOVEMENT = 0.3  # of the model, likewise; more than strains alone would move it


def linearised_loads(
    system: System, p: np.ndarray, load_factor: float, linear: LinearSolution, count: int
) -> np.ndarray:
    """Return the `count` lowest critical lambda (m,) above a load factor, K0 phi = -(lambda - lambda0) K_sigma phi.

    linear: the linear solution about the stable state p (n,). m < count if loads soften the model in fewer directions.
    Raises InputError if loads are not conservative.
    """
    effect = _effect(system, linear)
    if effect == 0.0:
        return np.empty(0)
    if not is_symmetric(system, csr_array(linear.stiffness + _CHANGE / effect * linear.geometric)):
        raise InputError(
            "some load follows the beam, so that its work depends on the motion: such loads can make a structure "
            "flutter before its tangent is singular",
            remedy="Look at the growth that solve_modes finds about a state",
        )
    shapes = _softened(linear.geometric, linear.factors, count, _NONE * effect)
    modes = np.zeros((shapes.shape[1], len(p)))
    modes[:, system.free_dofs] = shapes.T
    correction = np.zeros_like(p)
    zeros = np.zeros_like(p)
    unbalanced = residual(system, p, zeros, zeros, load_factor)[system.free_dofs]
    correction[system.free_dofs] = -linear.factors.solve(unbalanced)
    softening = -shapes.T @ (linear.geometric @ shapes)
    stiffness = stiffness_of_modes(system, p, load_factor, modes, correction)
    rates = eigh(0.5 * (softening + softening.T), stiffness, eigvals_only=True)[::-1]
    return np.asarray(load_factor + 1.0 / rates[rates > _NONE * effect][:count])


def linear_reach(system: System, linear: LinearSolution, linearised: np.ndarray) -> float:
    """Return the load factor up to which linear analysis counts: the last critical one (m,), or one that moves it far.

    Raises InputError if strains are too large before any of them. The path is then straight, so that linear analysis is
    right; otherwise only the path itself shows what is critical.
    """
    with np.errstate(divide="ignore"):
        moved = float(_MOVEMENT / np.float64(largest_movement(system, linear.slope)))
        strained = float(_STRAIN / np.float64(linear.strain))
    if strained < moved and not len(linearised):
        raise InputError(
            "no positive load factor is critical as the loading path starts: the loads stiffen the model. If they "
            "soften it later, trace_equilibrium finds it"
        )
    if strained < moved and linearised[0] > strained:
        raise InputError(
            f"no load is critical at strains below {_STRAIN:.0%}, up to which linear analysis counts: its lowest "
            f"critical load strains the model by {linear.strain * linearised[0]:.0%}. trace_equilibrium finds critical "
            "points on the path itself, whatever its strains"
        )
    return min(float(linearised[-1]) if len(linearised) else np.inf, moved)


def _effect(system: System, linear: LinearSolution) -> float:
    """Return the size of K0^-1 K_sigma, the largest fraction of the stiffness that a load factor of 1 changes."""
    scale = system.scale[system.free_dofs]
    x = first_vector(len(scale)) * scale
    sizes = []
    for _ in range(2):
        x = linear.factors.solve(linear.geometric @ x)
        sizes.append(float(np.linalg.norm(x / scale)))
    return sizes[1] / sizes[0] if sizes[0] > 0.0 else 0.0


def _softened(geometric: csr_array, factors: Factorised, count: int, none: float) -> np.ndarray:
    """Return a basis (unknown, m) of the shapes that lose the largest fraction of their stiffness per unit load.

    none: fraction that is round-off. The inverse of the tangent times -K_sigma is not symmetric, but it contains no
    sums of large terms that cancel.
    """
    n = geometric.shape[0]

    def lost(x: np.ndarray) -> np.ndarray:
        return -factors.solve(geometric @ x)

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
