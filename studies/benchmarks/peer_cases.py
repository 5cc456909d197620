"""The two tasks that beamfem and Exudyn share, and what is right: the paper's pendulum and a cantilever."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import beamfem as bf

if TYPE_CHECKING:
    from studies.benchmarks.exudyn_models import Peer

TWO_NODES, THREE_NODES, CABLE = "geometrically exact, 2 nodes", "geometrically exact, 3 nodes", "ANCF cable"
DENSE, SPARSE = "EXUdense", "EigenSparse"
LINEAR_SOLVERS = (DENSE, "EigenDense", SPARSE)
STRUCTURAL = bf.BilinearCRBF(forces=bf.Structural(), integration="reduced")


@dataclass(frozen=True)
class Chain:
    """A straight beam along x.

    length [m]; axial, shear [N] and bending [N m^2] stiffness; mass [kg/m]; rotary [kg m]; clamped: else pinned;
    gravity [m/s^2], force at the tip [N].
    """

    length: float
    axial: float
    shear: float
    bending: float
    mass: float
    rotary: float
    clamped: bool
    gravity: float = 0.0
    force: float = 0.0


@dataclass(frozen=True)
class Linkage:
    """Bars in a row with hinges between them, from rest; a constant torque [N m] turns the first about its start.

    points (bars + 1): the ends of the bars [m]; slider: mass [kg] at the last point, which slides along x; 0: it is
    pinned; duration [s].
    """

    name: str
    points: tuple[tuple[float, float], ...]
    bars: tuple[Chain, ...]
    torque: float
    duration: float
    slider: float = 0.0


RUBBER, PRINTED = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(area=1.6e-3, second_moment=8.533e-6)
STEEL, SQUARE = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
PENDULUM = Chain(
    1.2, 1120.0, 5.0 / 6.0 * 1120.0 / 2.6, 0.7e6 * 8.533e-6, 5540.0 * 1.6e-3, 5540.0 * 8.533e-6, False, gravity=9.81
)
_AREA, _SECOND = 1e-4, 1e-8 / 12.0
CANTILEVER = Chain(
    1.0,
    2e11 * _AREA,
    5.0 / 6.0 * 2e11 / 2.6 * _AREA,
    2e11 * _SECOND,
    7800.0 * _AREA,
    7800.0 * _SECOND,
    True,
    force=5.0 * 2e11 * _SECOND,
)

# Tip at 0.1, 0.2, ..., 1.0 s, spectral elements with Runge-Kutta of order 8, within 3e-8 m.
INSTANTS = 0.1 * np.arange(1, 11)
REISSNER_TIPS = np.array(  # case 10c: Reissner's beam, k_s = 5/6
    [
        (1.200000000, -0.049050000),
        (1.193239007, -0.190838925),
        (1.126210274, -0.484285098),
        (0.872149422, -0.962463796),
        (0.354311304, -1.307082330),
        (-0.174437850, -1.341362138),
        (-0.562438510, -1.194005964),
        (-0.918477880, -0.897160350),
        (-1.175894817, -0.447448958),
        (-1.197012381, -0.072589980),
    ]
)
CONTINUUM_TIPS = np.array(  # case 11.vi: St. Venant-Kirchhoff continuum with a free director, 3D lambda
    [
        (1.199997545, -0.049061737),
        (1.191018909, -0.192738897),
        (1.115561318, -0.518803837),
        (0.827965381, -0.986624762),
        (0.323869899, -1.287022964),
        (-0.172301648, -1.295736050),
        (-0.614265571, -1.133844042),
        (-1.032867760, -0.765407117),
        (-1.184816935, -0.324208523),
        (-1.151251076, -0.026265715),
    ]
)
# P L^2 / E I = 5, L / h = 100, Reissner's beam by collocation, 12 digits
CANTILEVER_TIP = np.array([1.0 - 0.38764432832607, 0.71385896416489])


def pendulum(element: bf.Element, elements: int) -> bf.Model:
    """Return the pendulum of the paper with the section as printed, 0.253 m deep."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.2, 0.0)), elements, element, PRINTED, RUBBER)
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])


def cantilever(element: bf.Element, elements: int) -> bf.Model:
    """Return the cantilever under P L^2 / E I = 5, L / h = 100."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), elements, element, SQUARE, STEEL)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, CANTILEVER.force))])


def peer(kind: str, elements: int, chain: Chain) -> "Peer":
    """Return the same in Exudyn."""
    from studies.benchmarks import exudyn_models

    return exudyn_models.chain(kind, elements, chain, 0.1)


def swing(
    model: bf.Model, steps: int, duration: float = 1.0, method: bf.Integrator | bf.Scheme | None = None
) -> bf.Solution:
    """March, by the trapezoidal rule unless told otherwise, and keep every tenth of a second, as the peer does."""
    step, method = duration / steps, method or bf.GeneralizedAlpha(1.0)
    return bf.simulate(model, duration=duration, step=step, integrator=method, save_every=round(0.1 / step))


def tips_of(solution: bf.Solution) -> np.ndarray:
    """Return the tip at the instants that are known and were reached (times, 2) [m]."""
    reached = INSTANTS[: np.searchsorted(INSTANTS, solution.time[-1] + 1e-9)]
    rows = np.round(reached / solution.time[1]).astype(int)
    return solution.position(solution.model.beams[0].end)[rows]


def motion_errors(tips: np.ndarray, known: np.ndarray | None) -> tuple[float, float]:
    """Return the largest error of the tip over its instants, and that at the last one [m]; nan where none is known."""
    if known is None or not len(tips):
        return np.nan, np.nan
    errors = np.abs(tips - known[: len(tips)]).max(axis=1)
    return float(errors.max()), float(errors[-1])


def tips_known(element: bf.Element) -> np.ndarray | None:
    """Return what the pendulum of an element converges to, None where no reference is known."""
    if isinstance(element.forces, bf.Structural):
        return REISSNER_TIPS
    return CONTINUUM_TIPS if element.name == "ANCF" else None


def static_error(tip: np.ndarray) -> float:
    """Return the error of the cantilever's tip [m]."""
    return float(np.abs(tip - CANTILEVER_TIP).max())
