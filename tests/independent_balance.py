"""Whether a state is in balance: each coordinate by complex steps of the energy, and the whole by its reactions."""

from dataclasses import dataclass, replace

import numpy as np
from complex_steps import cross, elastic, external, nodal_force, sprung, to_coordinates
from scipy.linalg import LinAlgError

import beamfem as bf
from beamfem.equations.equations import linearise
from beamfem.equations.system import system_of
from beamfem.results.axis_points import axis, nodal_vectors

# of all that acts; solvers are content with 1e-9 of the largest force
TOLERANCE = 2e-9
# the same of sums over all rows: each may leave its own, and a model of the fuzz has some thousands
TOLERANCE_OF_SUMS = 1e-7
# times what a change of the last digit of the coordinates leaves in a row: it sums up 5 points of 2 elements, whose
# strains have about 12 terms, each of which is rounded by half a digit. States with an error of 1e-3 in their
# displacements pass only where these are below 1e-9 of the model: strains of which doubles keep no three digits
LAST_DIGITS = 60.0
# of the model: an equilibrium so near to a static state cannot be told from it; this much is never asked of any result,
# so that it hides no error that anybody could see
NEAR = 64.0 * np.finfo(float).eps
STEPPED = 1e-9  # of the model: the same for a step of a motion, which is iterated to that
_SAMPLES = 8  # of so many a root mean square is never far below the true one, as the largest of three may be


@dataclass(frozen=True)
class Balance:
    """What is left over of each coordinate and of the whole, times the model's size [N m], and what that may be."""

    rows: float
    allowed: float
    whole: float
    allowed_whole: float
    acting: float

    @property
    def holds(self) -> bool:
        return self.rows <= 1.0 and self.whole <= self.allowed_whole

    def __str__(self) -> str:
        return (
            f"worst row {self.rows:.2e} of what it may be ({self.allowed:.2e} N m), "
            f"whole {self.whole:.2e} of {self.allowed_whole:.2e}, acting {self.acting:.2e}"
        )


def balance(solution: bf.Solution, row: int = -1) -> Balance:
    """Return the balance of a row of a solution; loads of static ones are those of its load factor."""
    model, p = solution.model, solution.p[row]
    system = system_of(model, solution.static)
    at = float(solution.at[row])
    scale, size = system.scale, system.extent
    inner = elastic(model, p, at, solution.static)
    outer, acting, parts = np.zeros(model.size), 0.0, np.zeros(3)
    for mesh in model.meshes:
        e = nodal_vectors(mesh, p[None])
        for forces in external(mesh, model, solution, row, at, solution.static):
            outer += to_coordinates(mesh, p, nodal_force(mesh, forces, e[0]), model.size)
            now = axis(mesh, e, forces.element, forces.xi)
            moments = cross(now.r[0], forces.on_r) + cross(now.d[0], forces.on_d) + forces.moment
            parts += [*forces.on_r.sum(axis=0), moments.sum()]
            acting += size * float(np.abs(forces.on_r).sum()) + float(np.abs(forces.moment).sum())
            acting += float(np.abs(forces.on_d).sum())
    outer += sprung(model, p - system.reference)
    floor = floor_of(solution, row)
    left = inner - outer
    free = system.free_dofs
    unbalanced = np.zeros(model.size)
    unbalanced[free] = system.along_free(left)
    supported = np.abs((left - unbalanced) * scale)
    acting += float(supported.sum()) + float(np.abs(sprung(model, p - system.reference) * scale).sum())
    allowed = TOLERANCE * acting + LAST_DIGITS * floor * scale
    worst = int(np.argmax(np.abs(unbalanced * scale) / np.maximum(allowed, 1e-300)))
    share = float(np.abs(unbalanced * scale)[worst] / max(allowed[worst], 1e-300))
    if share > 1.0 and _away(solution, row, left) <= (NEAR if solution.static else STEPPED):
        share = 1.0
    only = solution[row:] if row == -1 else solution[row : row + 1]
    reach = size
    for point in _points(model):
        fx, fy, m = only.reaction(point)[0]
        x, y = only.position(point)[0]
        reach = max(reach, abs(x), abs(y))
        parts += [fx, fy, m + x * fy - y * fx]
        acting = max(acting, size * max(abs(fx), abs(fy)), abs(m))
    reach = max(reach, float(np.abs(p[system.positions]).max(initial=0.0)))
    whole = max(size * abs(parts[0]), size * abs(parts[1]), abs(parts[2]) * size / reach)
    noise = float((floor * scale).max(initial=0.0))
    return Balance(share, float(allowed[worst]), float(whole), TOLERANCE_OF_SUMS * acting + LAST_DIGITS * noise, acting)


def _away(solution: bf.Solution, row: int, left: np.ndarray) -> float:
    """Return how far the equilibrium is from a row that leaves forces (n,), as a share of the model or of a radian.

    By the tangent, of a motion that of a step: K + 4 M / h^2, as stiff as the integrators of any damping have it.
    """
    system = system_of(solution.model, solution.static)
    state, at = (solution.p[row], solution.v[row], solution.a[row]), float(solution.at[row])
    inertia = 0.0 if solution.static else 4.0 / float(np.diff(solution.at).min()) ** 2
    _, tangent = linearise(system, *state, at, (1.0, 0.0, inertia))
    try:
        step = tangent.factorised(system.rotated).solve(left[system.free_dofs])
    except (LinAlgError, ValueError):
        return np.inf
    turn = np.maximum(np.abs(state[0]), 1.0)
    reach = max(system.extent, float(np.abs(state[0][system.positions]).max(initial=0.0)))
    size = np.where(system.positions, reach, turn)[system.free_dofs]
    return float(np.abs(step / size).max())


def floor_of(solution: bf.Solution, row: int = -1) -> np.ndarray:
    """Return the root mean square of what forces (n,) change by with the last digits of the coordinates.

    Of elastic forces, springs and foundations, which may be the stiffer ones.
    """
    model, p, at = solution.model, solution.p[row], float(solution.at[row])
    only, system = solution[row:] if row == -1 else solution[row : row + 1], system_of(solution.model, True)

    def forces(q: np.ndarray) -> np.ndarray:
        result, moved = (
            elastic(model, q, at, solution.static) - sprung(model, q - system.reference),
            replace(only, p=q[None]),
        )
        for mesh in model.meshes:
            e = nodal_vectors(mesh, q[None])[0]
            for acting in external(mesh, model, moved, 0, at, solution.static):
                result -= to_coordinates(mesh, q, nodal_force(mesh, acting, e), model.size)
        return result

    reach = max(system.extent, float(np.abs(p[system.positions]).max(initial=0.0)))
    last = np.finfo(float).eps * np.where(system.positions, reach, np.maximum(np.abs(p), 1.0))
    rng, now = np.random.default_rng(1), forces(p)
    changes = [forces(p + rng.choice([-1.0, 1.0], len(p)) * last) - now for _ in range(_SAMPLES)]
    return np.asarray(np.sqrt(np.mean(np.square(changes), axis=0)))


def _points(model: bf.Model) -> list[bf.Point]:
    """Points of supports, each once."""
    found: dict[tuple[int, float], bf.Point] = {}
    for support in model.point_supports:
        found.setdefault((id(support.point.beam), round(support.point.fraction, 9)), support.point)
    return list(found.values())
