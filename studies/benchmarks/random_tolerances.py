"""Errors of random motions whose steps follow a tolerance, beside the tolerance, and what they cost.

The motions of `random_motions` over two periods, 1 s at most, against `Radau(4)` with a far smaller tolerance:
python -m studies.benchmarks.random_tolerances [first] [last].
"""

import sys
import time
import warnings

import numpy as np

import beamfem as bf
from beamfem.equations.system import system_of
from studies.benchmarks.random_motions import Case, case

TOLERANCES: tuple[float, ...] = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
INTEGRATORS = (bf.Radau(2), bf.Radau(3), bf.Radau(4), bf.Gauss(3), bf.GeneralizedAlpha())
_FINER = 0.05  # of the smallest tolerance: that of the reference
_INSTANTS = 10


def run(found: Case, tolerance: float, integrator: bf.Integrator | bf.Scheme) -> bf.Solution:
    """Return the motion of a case, at ten instants."""
    duration = min(2.0 * found.period, 1.0)
    at = np.linspace(duration / _INSTANTS, duration, _INSTANTS)
    return bf.simulate(found.model, duration, None, integrator, found.start, tolerance=tolerance, save_at=at)


def error(motion: bf.Solution, exact: bf.Solution) -> float:
    """Return the largest error of a position, of the size of the model."""
    system = system_of(motion.model, static=False)
    return float(np.abs(motion.p - exact.p)[:, system.positions].max()) / system.extent


def main(first: int = 0, last: int = 100) -> None:
    """Print the errors of each motion over the tolerance, and which are within a factor of 10."""
    warnings.simplefilter("ignore")
    shares: dict[tuple[str, float], list[float]] = {}
    for seed in range(first, last):
        found = case(seed)
        try:
            exact = run(found, _FINER * min(TOLERANCES), bf.Radau(4))
        except bf.ConvergenceError as failed:
            print(f"{seed:4} {found}: {failed}", flush=True)
            continue
        for integrator in INTEGRATORS:
            cells = []
            for tolerance in TOLERANCES:
                begin = time.perf_counter()
                try:
                    share = error(run(found, tolerance, integrator), exact) / tolerance
                except bf.ConvergenceError:
                    share = np.inf
                shares.setdefault((repr(integrator), tolerance), []).append(share)
                cells.append(f"{share:.2g} ({time.perf_counter() - begin:.2f} s)")
            print(f"{seed:4} {found} {integrator}:", *cells, flush=True)
    for (name, tolerance), values in shares.items():
        within = np.mean([0.1 <= value <= 10.0 for value in values])
        print(f"{name} {tolerance:.0e}: {within:.0%} within a factor of 10, median {np.median(values):.2g}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
