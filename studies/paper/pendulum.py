"""The free-falling flexible pendulum of the paper, section 5: Figures 3 to 15 and Table 1.

E = 0.7e6 Pa, nu = 0.3, rho = 5540 kg/m^3, A = 1.6e-3 m^2, L = 1.2 m, pinned at one end, at first horizontal
and at rest.
I = 8.533e-6 m^4 as printed belongs to a rectangle 0.253 m deep; I = 8.533e-9 m^4 to 0.2 m x 0.008 m.
"""

import time
from dataclasses import dataclass

import numpy as np

import beamfem as bf

PRINTED, THIN = 8.533e-6, 8.533e-9
ELEMENTS = (bf.ANCF(), bf.ANCFCRBF(), bf.BilinearCRBF())
MESHES = (6, 12, 24, 100)


@dataclass(frozen=True)
class Run:
    """One motion: tip height and what happens at the midpoint of the last element, over time; CPU seconds it took."""

    solution: bf.Solution
    seconds: float
    time: np.ndarray
    tip: np.ndarray
    midpoint: bf.Fields

    @property
    def shear_strain(self) -> np.ndarray:
        return self.midpoint.green_strain.xy

    @property
    def length_of_r_x(self) -> np.ndarray:
        return np.linalg.norm(self.midpoint.r_x, axis=1)

    @property
    def length_of_r_y(self) -> np.ndarray:
        return np.linalg.norm(self.midpoint.r_y, axis=1)

    @property
    def direction_of_r_x(self) -> np.ndarray:
        return np.unwrap(np.arctan2(self.midpoint.r_x[:, 1], self.midpoint.r_x[:, 0]))

    @property
    def direction_of_r_y(self) -> np.ndarray:
        return np.unwrap(np.arctan2(self.midpoint.r_y[:, 1], self.midpoint.r_y[:, 0]))


def fall(element: bf.Element, elements: int, second_moment: float, duration: float, step: float) -> Run:
    """Let one pendulum fall; the time is that of a second call, so that nothing is compiled in it."""
    beam = bf.Beam(
        bf.Line((0.0, 0.0), (1.2, 0.0)),
        elements,
        element,
        bf.Section(area=1.6e-3, second_moment=second_moment, height=float(np.sqrt(12.0 * second_moment / 1.6e-3))),
        bf.Material(youngs_modulus=0.7e6, poisson_ratio=0.3, density=5540.0),
    )
    model = bf.Model([beam], supports=[bf.Pin(beam.start)], loads=[bf.Gravity((0.0, -9.81))])
    bf.simulate(model, duration=2 * step, step=step)
    begun = time.process_time()
    solution = bf.simulate(model, duration=duration, step=step)
    seconds = time.process_time() - begun
    midpoint = solution.fields(beam.at(1.0 - 0.5 / elements))
    return Run(solution, seconds, solution.time, solution.position(beam.end), midpoint)


def main(
    second_moment: float = PRINTED,
    duration: float = 1.2,
    step: float = 5e-4,
    meshes: tuple[int, ...] = MESHES,
) -> dict[tuple[str, int], Run]:
    """Return a run for each element name and number of elements.

    Parameters
    ----------
    second_moment : float, [m^4]
        Second moment of area I; 8.533e-9 is that of the thin section.
    duration : float, [s]
        Duration of the fall.
    step : float, [s]
        Time step.
    meshes : tuple of int
        Numbers of elements.
    """
    return {
        (element.name, count): fall(element, count, second_moment, duration, step)
        for element in ELEMENTS
        for count in meshes
    }


if __name__ == "__main__":
    for (name, count), run in main().items():
        half = np.searchsorted(run.time, 0.5 - 1e-9)
        drift = np.ptp(run.solution.energy().total)
        print(f"{name:14s} {count:4d} elements: tip at 0.5 s {run.tip[half].round(4)} m, ", end="")
        print(f"energy drift {drift:.1e} J, {1e3 * run.seconds:.0f} ms")
