"""Free vibration about a state."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations.equations import residual
from beamfem.equations.rigid_velocity import RigidVelocity, rigid_rates
from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.linalg.eigenpairs import Pairs, digits_for, general_pairs, nothing_known
from beamfem.model.beam import Beam
from beamfem.model.model import Model
from beamfem.precision.roundoff import LOSES
from beamfem.results.locking import stiffness_locking
from beamfem.results.solution import Solution, State
from beamfem.results.solution_checks import may_lock, warn_of
from beamfem.results.status import Finding, Statistics, Status, counted
from beamfem.solve.accuracy.adapted_mesh import Shares, prepared, refined_until, require_unlocked
from beamfem.solve.accuracy.carried_start import carried
from beamfem.solve.accuracy.coarse_mesh import WARNED, kept_coarse
from beamfem.solve.accuracy.error_estimate import enriched, enriched_state, mode_shares
from beamfem.solve.modes.mode_stiffness import (
    largest_translation,
    refuse_lost_digits,
    stresses_of,
    upright,
    weak_stiffness,
)
from beamfem.solve.modes.pencil import WRONG, Pencil, lowest_pairs
from beamfem.solve.modes.rigid_modes import unresisted
from beamfem.solve.start.mechanisms import require_independent
from beamfem.solve.start.start_checks import refuse_dampers, require_equilibrium
from beamfem.solve.start.start_state import resting_state
from beamfem.tables import as_pandas
from beamfem.validation import count as whole_number
from beamfem.validation import number_below, positive, squared, vector

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

_REAL = 1e-8  # imaginary parts of lambda below this fraction are round-off
_LOWEST = 10  # modes that default elements are refined for where no number is given
_MOST = 160  # modes that they are refined for at all
_SPARE = 4  # eigenvalues found beyond those asked for
_LARGE = 2.0**30  # acceleration beside whose inertia forces all others are round-off


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes of small vibration about a state: p(t) = p + Re(phi exp(s t)), s = growth + 2 pi i frequency.

    Parameters
    ----------
    model : Model
        The model.
    state : State
        The state to vibrate about.
    frequencies : array, [Hz], (count,)
        Frequencies, first the rigid ones, exactly 0, then ascending.
    growth : array, [1/s], (count,)
        0 if the state is stable, > 0 for divergence (frequency 0) and flutter, < 0 where damped.
    modes : array, (count, n)
        Shapes phi over all coordinates, phi^H M phi = 1, complex only with damping and if follower loads make the
        tangent unsymmetric.
    rigid : tuple of str
        What each rigid mode moves, in words.

    Examples
    --------
    >>> modes = bf.solve_modes(model, count=3)
    >>> modes.frequencies.round(1)
    array([ 20.8, 129.1, 355.2])

    See Also
    --------
    LinearModel.modes : With damping.
    """

    model: Model
    state: State
    frequencies: np.ndarray
    growth: np.ndarray
    modes: np.ndarray
    rigid: tuple[str, ...]

    def __repr__(self) -> str:
        listed = ", ".join(f"{value:.6g}" for value in self.frequencies[:12])
        warned = f"; {counted(len(self.warnings), 'warning')}, see its warnings" if self.warnings else ""
        return f"Modes({listed}{' ...' if len(self) > 12 else ''} {self.model.unit('Hz')}{warned})"

    def _repr_html_(self) -> str:
        from beamfem.view.summary import modes_table

        return modes_table(self)

    def __len__(self) -> int:
        return len(self.frequencies)

    @property
    def elastic(self) -> np.ndarray:
        """Frequencies [Hz] without the rigid modes, (count - rigid modes,)."""
        return self.frequencies[len(self.rigid) :]

    @property
    def angular_frequencies(self) -> np.ndarray:
        """Angular frequencies 2 pi f [rad/s], (count,)."""
        return 2.0 * np.pi * self.frequencies

    @property
    def status(self) -> Status:
        """UNSTABLE if a mode grows, otherwise COMPLETED; a solve that misses modes raises an error."""
        return Status.UNSTABLE if np.any(self.growth > 0.0) else Status.COMPLETED

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Warnings on the accuracy of the frequencies due to the mesh, in sentences; empty if there are none.

        `solve_modes` has issued those of errors of 1 % and more as Python warnings too.
        """
        found = stiffness_locking(self.state, self.modes[len(self.rigid) :], 0.5, "a frequency")
        return tuple(finding.sentence for finding in found)

    @property
    def ratios(self) -> np.ndarray:
        """Damping ratios -Re s / abs(s) [-], (count,); 0 for undamped vibrations and rigid modes, < 0 for growing ones.

        Examples
        --------
        >>> bf.solve_modes(model, count=2).ratios
        array([0., 0.])
        """
        size = np.hypot(self.growth, 2.0 * np.pi * self.frequencies)
        return np.asarray(-self.growth / np.where(size > 0.0, size, 1.0) + 0.0)

    def participation(self, direction: tuple[float, float] | RigidVelocity) -> np.ndarray:
        """Return the participation factors phi^T M r of undamped modes in a rigid motion r.

        Raises InputError for an invalid direction, and if shapes are complex.

        Parameters
        ----------
        direction : (float, float) or RigidVelocity
            Direction (x, y) of a translation with unit velocity, or the velocity of a rigid motion.

        Returns
        -------
        array, [kg^(1/2)], (count,)
            The factors, for a rotation of 1 rad/s [kg^(1/2) m].

        Examples
        --------
        >>> factors = bf.solve_modes(model, count=2).participation((0.0, 1.0))
        """
        if np.iscomplexobj(self.modes):
            raise InputError("participation factors are those of undamped modes, which are real; these are complex")
        system, p, motion = system_of(self.model, static=True), self.state.p, direction
        if not isinstance(motion, RigidVelocity):
            x, y = vector("direction", motion)
            size = float(np.hypot(x, y))
            if size == 0.0:
                raise InputError("direction must not be (0, 0)")
            motion = RigidVelocity((x / size, y / size))
        rates = _LARGE * rigid_rates(system, motion, p)
        ends = [residual(system, p, np.zeros_like(p), side * rates, self.state.at) for side in (1.0, -1.0)]
        return np.asarray(self.modes @ (ends[0] - ends[1]) / (2.0 * _LARGE))

    def effective_masses(self, direction: tuple[float, float] | RigidVelocity) -> np.ndarray:
        """Return the effective masses (phi^T M r)^2 of undamped modes in a direction.

        Summed over all modes they are the total mass, except the small fraction of it that elements at supports have at
        prescribed coordinates. Raises InputError as `participation` does.

        Parameters
        ----------
        direction : (float, float) or RigidVelocity
            Direction (x, y), or a rigid motion, see `participation`.

        Returns
        -------
        array, [kg], (count,)
            The masses, for a rotation of 1 rad/s the moments of inertia [kg m^2].

        Examples
        --------
        >>> modes = bf.solve_modes(model, count=3)
        >>> (modes.effective_masses((0.0, 1.0)) / model.mass).round(3)
        array([0.613, 0.189, 0.066])
        """
        return self.participation(direction) ** 2

    def error(self, mode: int = 0) -> float:
        """Return an estimate of the discretisation error of a frequency: its change [Hz] on an enriched space.

        The equilibrium and its modes are found with elements of order k + 1 instead of k = 1 or 2, and halves of other
        ones; modes are compared by their number.

        Parameters
        ----------
        mode : int, default 0
            Row of the mode.

        Returns
        -------
        float, [Hz]
            Frequency on the enriched space less that of the mode, to be added to it.

        Raises
        ------
        InputError
            If there is no such mode, and for damped modes of a `LinearModel`.
        ConvergenceError
            If there is no equilibrium nearby on finer elements.

        Examples
        --------
        >>> abs(bf.solve_modes(model, count=2).error(0)) < 0.01
        True
        """
        number = number_below("mode", mode, len(self), -len(self)) % len(self)
        if np.any(self.growth < 0.0):
            raise InputError("errors are estimated for undamped modes, as solve_modes finds them")
        state = enriched_state(self.state)
        finer = solve_modes(state.model, number + 1, about=state)
        return float(finer.frequencies[number] - self.frequencies[number])

    def solution(self, mode: int = 0, amplitude: float | None = None, frames: int = 25) -> Solution:
        """Return one period of a mode as a Solution to draw or export.

        For a rigid mode it is one second of its motion, for a divergence the time in which it grows by the factor e. It
        is exact for small amplitudes. amplitude [m]: largest displacement of a node, by default a tenth of the longest
        beam; frames: number of rows. Raises InputError for a mode that does not exist, or less than two frames.

        >>> motion = bf.solve_modes(model, count=2).solution(mode=1, amplitude=0.05)
        >>> len(motion)
        25
        """
        mode = number_below("mode", mode, len(self))
        if whole_number("frames", frames) < 2:
            raise InputError("frames must be at least 2")
        if amplitude is None:
            amplitude = 0.1 * max(beam.curve.length for beam in self.model.beams)
        amplitude = squared(positive)("amplitude", amplitude)
        shape = amplitude / largest_translation(self.model, self.state.p, self.modes[mode]) * self.modes[mode]
        frequency, growth = self.frequencies[mode], self.growth[mode]
        at = np.linspace(0.0, 1.0 / (frequency or abs(growth) or 1.0), frames)
        rate = growth + 2j * np.pi * frequency
        if rate == 0.0:
            p, v, a = (np.outer(weight, np.real(shape)) for weight in (at, np.ones(frames), np.zeros(frames)))
        else:
            moved = np.outer(np.exp(rate * at), shape)
            p, v, a = (np.real(rate**order * moved) for order in range(3))
        statistics = Statistics(0, frames - 1, 0, "a mode of small vibration")
        loaded = np.full(frames, self.state.at)
        return Solution(self.model, False, at, self.state.p + p, v, a, statistics, loaded=loaded)

    def start(self, mode: int = 0, amplitude: float | None = None) -> State:
        """Return the state in which the motion of a mode begins, the first row of its `solution`; `simulate` takes it.

        The model is displaced by the shape and at rest. A rigid mode starts undisplaced with a velocity; a growing or
        complex mode has both. amplitude: largest displacement of a node [m], for a rigid mode largest velocity [m/s].
        Joints with multipliers are displaced further, to where their conditions hold. Raises InputError for a mode that
        does not exist.

        >>> struck = bf.solve_modes(model, count=2).start(mode=1, amplitude=1e-3)
        >>> motion = bf.simulate(model.with_loads([]), duration=0.01, step=1e-4, start=struck)
        """
        from beamfem.solve.motion.consistent_rows import on_conditions

        begin = self.solution(mode, amplitude, 2)[0]
        p, v, a = on_conditions(system_of(self.model, static=False), np.array([[begin.p, begin.v, begin.a]]))[0]
        return replace(begin, p=p, v=v, a=a)

    def to_pandas(self) -> "DataFrame":
        """Return frequency [Hz], growth [1/s] and rigid motion of the modes as a table, one row per mode.

        Raises MissingPackageError without pandas.
        """
        rigid = [*self.rigid, *[""] * (len(self) - len(self.rigid))]
        rows = list(zip(self.frequencies.tolist(), self.growth.tolist(), rigid, strict=True))
        return as_pandas(("frequency", "growth", "rigid"), rows)

    def to_xarray(self, beam: Beam | None = None) -> "Dataset":
        """Return frequencies [Hz], growth [1/s] and rigid motions (mode,), and shapes ux, uy (mode, station), as a
        Dataset.

        Shapes are along a beam, or along all beams, scaled as `modes`, the real part of complex ones. Raises InputError
        for a beam of another model, MissingPackageError without xarray.

        >>> bf.solve_modes(model, count=2).to_xarray(beam)["frequency"].values.round(1)
        array([ 20.8, 129.1])
        """
        from beamfem.io.table import modes_to_xarray

        return modes_to_xarray(self, beam)

    def plot(self, path: str | PathLike[str] | None = None, *, most: int = 6, ax: Any = None) -> "Figure":
        """Draw at most `most` modes, each with its frequency, and return the figure.

        Dark: the mode at its largest; pale: half a period later; dashed: the reference. path: file to write (PNG, SVG,
        PDF); ax: as many axes as modes are drawn, see `Solution.plot`. Raises InputError if there are no modes to draw,
        or for another number of axes; MissingPackageError without matplotlib.
        """
        from beamfem.view.mode_shapes import plot_modes

        return plot_modes(self, path, most, ax)


def solve_modes(
    model: Model, count: int = 10, about: State | Solution | None = None, *, accuracy: float | None = None
) -> Modes:
    """Find the lowest modes of vibration, K phi = omega^2 M phi, including those of rigid motions.

    K is the tangent stiffness with the loads at the load factor of the state, and M the mass matrix, both in that
    state. In a rotating frame, K has the centrifugal forces; `LinearModel.modes` has Coriolis forces too. Warns with
    LockingWarning if locking changes a frequency by 1 % or more.

    Parameters
    ----------
    model : Model
        Beams, supports and loads.
    count : int, default 10
        Number of modes.
    about : State or Solution, optional
        Static equilibrium to vibrate about, whose loads and stresses are then taken into account (prestress, gravity):
        a state, or a solution for its last state; it may come from a model with other supports. By default the
        reference at load factor 0.
    accuracy : float, [-], optional
        Refine the mesh, as `solve_static` does, until the estimated relative error of every frequency, see
        `Modes.error`, is at most this number.

    Raises
    ------
    InputError
        For an invalid argument, or a state that is not in equilibrium; for an accuracy and elements that lock.
    ConvergenceError
        If modes were missed, no mesh reaches the accuracy, or round-off of very stiff parts leaves no three digits.

    Examples
    --------
    >>> bf.solve_modes(model, count=2).frequencies.round(2)
    array([ 20.85, 129.12])
    """
    whole_number("count", count)
    refuse_dampers(system_of(model, static=True))
    own = model
    model, accuracy = prepared(model, accuracy, about)
    if accuracy is not None:
        return refined_until(model, accuracy, lambda model: _attempt(model, count, about))
    modes, findings = _modes(model, count, about)
    warn_of(findings)
    if own.automatic:
        finer = _modes(enriched(model), count, enriched_state(modes.state))[0]
        off = float(np.max(_errors(modes, finer), initial=0.0))
        if off > WARNED:
            remedy = "give the whole solution, which tells its history, or find it with more elements"
            warn_of([kept_coarse(f"a frequency is off by about {100.0 * off:.2g} %", remedy)])
    return modes


def meshed_for_modes(
    model: Model, about: State | Solution | None, highest: float = 0.0
) -> tuple[Model, State | Solution | None]:
    """Return a model whose default elements are refined for its lowest modes about a state, and the state on them.

    They are the lowest ones up to a frequency `highest` [Hz] at least. Raises InputError if these are too many.
    """
    model, accuracy = prepared(model, None, about)
    if accuracy is None:
        return model, about
    count = _LOWEST
    while count <= _MOST:
        modes = refined_until(model, accuracy, partial(_attempt, count=count, about=about))
        if modes.frequencies[-1] >= highest:
            return modes.model, modes.state
        count *= 2
    raise InputError(
        f"the default elements resolve {_MOST} modes at most, here up to {modes.frequencies[-1]:.4g} "
        f"{model.unit('Hz')}, and {highest:.4g} {model.unit('Hz')} is above them: give the beams elements"
    )


def _attempt(model: Model, count: int, about: State | Solution | None) -> tuple[Modes | None, float, Shares]:
    """Return the modes about a state, and the largest relative error of their frequencies that is estimated."""
    if len(system_of(model, static=True).free_dofs) < 2 * count:
        return None, np.inf, None
    modes, findings = _modes(model, count, carried(about, model))
    require_unlocked(findings)
    richer = enriched(model)
    finer = _modes(richer, count, carried(about, richer))[0]
    elastic, errors = finer.frequencies > 0.0, _errors(modes, finer)
    shapes = zip(np.real(modes.modes[elastic]), np.real(finer.modes[elastic]), strict=True)
    stiffness = (2.0 * np.pi * finer.frequencies[elastic]) ** 2  # with a modal mass of 1
    shares = mode_shares(((modes.state, a, finer.state, b) for a, b in shapes), 2.0 * errors, stiffness)
    return modes, float(np.max(errors, initial=0.0)), shares or None


def _errors(modes: Modes, finer: Modes) -> np.ndarray:
    """Return the relative errors (m,) of elastic frequencies beside those of a finer mesh."""
    elastic = finer.frequencies > 0.0
    return np.asarray(np.abs(modes.frequencies[elastic] / finer.frequencies[elastic] - 1.0))


def _modes(model: Model, count: int, about: State | Solution | None) -> tuple[Modes, Sequence[Finding]]:
    """Return the modes, and warnings of them."""
    system = system_of(model, static=True)
    system.forget_digits()
    p, load_factor = resting_state(system, about)
    unknown = len(system.free_dofs)
    if count > unknown:
        raise InputError(f"count is {count}, but this model has only {unknown} unknown coordinates")
    require_independent(system, p)
    pencil = Pencil(system, p, load_factor)
    require_equilibrium(system, p, load_factor, "vibrate")
    if count > pencil.size:
        raise InputError(f"count is {count}, but supports leave this model only {pencil.size} modes")
    with digits_for("modes"):
        rigid, words = unresisted(pencil)
        missing, free = max(count - len(rigid), 0), rigid[:, system.free_dofs].T
        squares, vectors = (lowest_pairs if pencil.symmetric else _general)(pencil, missing, free)
    if missing and system.connectors.items:  # whose stiffness is assembled
        weak = weak_stiffness(system, p, load_factor, stresses_of(system, p, np.zeros_like(p), load_factor))
        whole = system.scale[system.free_dofs]
        whole = whole / np.sqrt(whole @ (pencil.mass @ whole))  # as a mode may be that is missing
        for square, x in [(squares[missing - 1], whole), *zip(squares[:missing], vectors.T, strict=False)]:
            # frequencies lose the square of what vectors lose
            refuse_lost_digits(system, system.free_dofs, weak, x, np.sqrt(LOSES) * abs(square), "a mode")
    rates = _rates(squares)
    order = np.lexsort((-rates.real, rates.imag))
    shapes = np.zeros((missing, model.size), dtype=vectors.dtype)
    shapes[:, system.free_dofs] = vectors[:, order].T[:missing]
    shapes = np.concatenate([rigid[:count], shapes])
    rates = np.append(np.zeros(len(rigid)), rates[order])[:count]
    rest_state = State(p, np.zeros_like(p), np.zeros_like(p), load_factor, model)
    frequencies = rates.imag / (2.0 * np.pi)
    modes = Modes(model, rest_state, frequencies, rates.real, upright(model, shapes), words[:count])
    locks = may_lock(system, rest_state.p)
    return modes, stiffness_locking(rest_state, modes.modes[len(modes.rigid) :], 0.5, "a frequency") if locks else ()


def _general(pencil: Pencil, count: int, rigid: np.ndarray) -> Pairs:
    """Return complex omega^2 (m,) and vectors (unknown, m) for an unsymmetric tangent; see `lowest_pairs`."""
    if count == 0:
        return nothing_known(pencil.size)
    shift, factors, lost = pencil.begin(rigid.shape[1])
    if lost > WRONG:
        factors = pencil.exact(shift).factorised(pencil.system.rotated)
    known = np.full(rigid.shape[1], -1.0 / shift), rigid
    reciprocal, vectors = general_pairs(pencil.mass, factors, count + _SPARE, known)
    finite = np.abs(reciprocal) > np.finfo(float).eps * np.abs(reciprocal).max()
    vectors = vectors[:, finite]
    sizes = np.real((np.conj(vectors) * (pencil.mass @ vectors)).sum(axis=0))
    return shift + 1.0 / reciprocal[finite], vectors / np.sqrt(sizes)


def _rates(squares: np.ndarray) -> np.ndarray:
    """Return s = growth + i omega (m,) with s^2 = -omega^2 and omega >= 0.

    Of a conjugate pair of omega^2, one gives the growing motion and the other the decaying one.
    """
    squares = np.asarray(squares, dtype=complex)
    real = np.abs(squares.imag) <= _REAL * np.abs(squares)
    squares = np.where(real, squares.real, squares)
    rates = np.sqrt(-squares)
    return np.where(rates.imag < 0.0, -rates, rates) + 0.0
