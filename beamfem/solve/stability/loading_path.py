"""A loading path: its points, the stiffness of the softest modes there, and sizes of movements along it."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from beamfem.assembly.system import System
from beamfem.errors import BeamfemError, ConvergenceError
from beamfem.kernels.block import GRADIENTS, ROTATED_GRADIENTS
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics, Status
from beamfem.solve.continuation.continuation import PathPoint, begin
from beamfem.solve.continuation.steps import longest_step, too_small
from beamfem.solve.modes.pencil import Pencil, lowest_pairs
from beamfem.solve.newton.newton import Newton, Termination


def size_of(system: System) -> float:
    """Return twice the largest distance [m] of a node from the centre of all beams, the length of a straight one.

    `System.extent` is no measure of results: it is the length of the longest beam, and halves are shorter.
    """
    chains = [mesh.position for mesh in system.model.meshes]
    steps = np.concatenate([np.diff(chain, axis=0) for chain in chains])
    middles = np.concatenate([0.5 * (chain[1:] + chain[:-1]) for chain in chains])
    lengths = np.hypot(*steps.T)
    centre = lengths @ middles / lengths.sum()
    return 2.0 * float(np.hypot(*(np.concatenate(chains) - centre).T).max())


def largest_displacement(system: System, change: np.ndarray) -> float:
    """Return the largest displacement [m] of a node by a change (n,)."""
    places = np.concatenate([block.dof[:, :2] for block in system.blocks])
    return float(np.hypot(*change[places.T]).max())


def largest_movement(system: System, change: np.ndarray) -> float:
    """Return the largest component of a change (n,): displacements in sizes of the model, gradients, angles [rad]."""
    padded = np.append(change, 0.0)
    largest = largest_displacement(system, change) / size_of(system)
    for block in system.blocks:
        plain = np.isin(block.node_kind, (GRADIENTS, ROTATED_GRADIENTS))
        rotations, gradients = block.dof[~plain, 2:], block.dof[plain, 2:].reshape(-1, 2)
        moved = np.hypot(*padded[gradients].T), np.abs(padded[rotations])
        largest = max(largest, *(float(values.max(initial=0.0)) for values in moved))
    return largest


_ITERATIONS = 15
_FIRST_STEP = 0.02
_LARGEST_TURN = 0.3  # [rad] by which the tangent of the path may turn in a step
_LARGEST_CORRECTION = 0.3  # of a step
_GROWTH = 3.0
_REFUSALS = 12  # of steps from one point in which critical points cannot be distinguished


class PathLostError(BeamfemError):
    """The path cannot be followed any further; the message gives the reason."""


class InvertedError(PathLostError):
    """An equilibrium is turned inside out: the path ends before it."""


@dataclass(frozen=True, eq=False)
class Softest:
    """The lowest lambda (m,) [1/s^2] of K phi = lambda M phi, ascending, and phi (unknown, m), phi^T M phi = 1."""

    values: np.ndarray
    vectors: np.ndarray


class LoadingPath:
    """The path through a state towards larger load factors."""

    def __init__(self, system: System, p: np.ndarray, load_factor: float) -> None:
        self.system = system
        self.line, self.start = begin(system, p, load_factor, Newton(iterations=_ITERATIONS))
        self.points = [self.start]
        self.size = self._next_size = _FIRST_STEP
        self.refused, self.lost = 0, False
        self._shift = 0.0

    def advance(self, point: PathPoint) -> PathPoint:
        """Return the next point of the path, by a step as long as its curvature allows.

        Raises InvertedError, PathLostError.
        """
        size = min(self.size, longest_step(self.line, point))
        lost = PathLostError(
            f"beyond load factor {point.load_factor:.6g} its steps are so short that round-off hides them"
        )
        while not too_small(self.line, point, size):
            change = size * point.tangent
            try:
                following = self.corrected(point.y + change, point.y, self.line.plane(point.tangent), point.tangent)
            except PathLostError as error:
                lost = error
            else:
                aside = self.line.length(following.y - point.y - change)
                turn = float(np.arccos(np.clip(self.line.dot(following.tangent, point.tangent), -1.0, 1.0)))
                if aside <= _LARGEST_CORRECTION * size and turn <= _LARGEST_TURN:
                    self.size = size
                    self._next_size = size * min(_GROWTH, 0.5 * _LARGEST_TURN / max(turn, 1e-12))
                    return following
                lost = PathLostError("the path turns too sharply")
            size *= 0.5
        self.size = size
        raise lost

    def shorten(self, point: PathPoint) -> bool:
        """Shorten the next step; return whether it is still worth taking."""
        self.size *= 0.5
        self.refused += 1
        self.lost = self.refused > _REFUSALS or too_small(self.line, point, self.size)
        return not self.lost

    def add(self, point: PathPoint) -> PathPoint:
        """Add a point up to which all critical points are known, and return it in the scale of the next step."""
        self.line, rescaled = self.line.rescaled(point)
        self.points.append(rescaled)
        self.refused = 0
        self.size = self._next_size * self.line.length(point.tangent)
        return rescaled

    def normal(self, before: PathPoint, after: PathPoint) -> np.ndarray:
        """Return the direction (n + 1,) along which distances between two points are measured."""
        chord = after.y - before.y
        return self.line.plane(chord / self.line.length(chord))

    def unbalanced(self, point: PathPoint) -> np.ndarray:
        """Return the residual (n,) of the unknown coordinates at a point."""
        result = np.zeros(len(point.y) - 1)
        unbalanced = Pencil(self.system, point.y[:-1], point.load_factor).unbalanced
        result[self.system.free_dofs] = unbalanced
        return result

    def moved(self, p: np.ndarray) -> float:
        """Return the largest movement of a node from the start to a state p (n,), in sizes of the model."""
        return largest_displacement(self.system, p - self.start.y[:-1]) / size_of(self.system)

    def solution(self) -> Solution:
        """Return the points found before the path was lost, as a solution."""
        rows = np.array([point.y for point in self.points])
        p, at = rows[:, :-1], rows[:, -1]
        ended = "the equilibria that were found on the loading path"
        statistics = Statistics(0, len(rows) - 1, 0, ended, Status.STOPPED)
        return Solution(self.system.model, True, at, p, np.zeros_like(p), np.zeros_like(p), statistics)

    def corrected(self, start: np.ndarray, base: np.ndarray, normal: np.ndarray, like: np.ndarray) -> PathPoint:
        """Return the point of the path in the plane through `start` normal to `normal` (n + 1,), with stresses
        predicted from `base` and the tangent in the sense of `like`. Raises InvertedError, PathLostError.
        """
        corrected = self.line.correct(start, self.line.stresses(base, start - base), normal)
        if corrected.ended is Termination.INVERTED:
            raise InvertedError(corrected.ended.value)
        if not corrected.ended.good:
            raise PathLostError(corrected.ended.value)
        try:
            return self.line.linearised(corrected.y, like)
        except LinAlgError:
            raise PathLostError("the tangent is singular") from None

    def softest(self, point: PathPoint, count: int) -> Softest:
        """Return the `count` softest modes, without gaps. Raises ConvergenceError."""
        pencil = Pencil(self.system, point.y[:-1], point.load_factor)
        none = np.empty((len(self.system.free_dofs), 0))
        shift = self._shift or None
        while shift is not None and not pencil.clear_of(shift):
            shift *= 4.0
        pairs = lowest_pairs(pencil, min(count, pencil.size), none, shift)
        if not len(pairs[0]):
            raise ConvergenceError("round-off leaves no digits of the softest modes of the tangent")
        # of the size of the lowest eigenvalues, which change little from one state to the next
        self._shift = 2.0 * min(float(pairs[0][0]), 0.0) - float(np.abs(pairs[0][:2]).max())
        return Softest(pairs[0][:count], pairs[1][:, :count])
