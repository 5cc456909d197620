"""Forces in the rows of methods without damping, which solve the equations between the rows."""

import numpy as np

from beamfem.equations.equations import ROUND_OFF, sizes
from beamfem.equations.system import System
from beamfem.errors import TimeStepWarning, warn
from beamfem.results.energy_balance import masses
from beamfem.results.solution import Solution

_OF_COLLOCATION = 3  # numbers of a rule, see `Statistics`
_ROUND_OFF = 1e4 * ROUND_OFF  # of forces, which undamped vibrations add up over many steps
_ROWS = 10_000  # at most, from the end: vibrations that nothing damps are there as well
_BEYOND = 100.0  # square of what is not explained by velocities, in sum over rows, over what is


def undamped_rows(solution: Solution, system: System) -> tuple[str, ...]:
    """Warn of accelerations in rows, by methods that damp nothing, that do not lead to their velocities.

    What is stiff is in balance at the stages, and strained beside them by what steps do not resolve: the motion hardly
    shows it, but forces in rows do. Return the sentence.
    """
    rule = solution.statistics.rule
    if len(rule) != _OF_COLLOCATION or rule[2] > 0.0 or not 1.5 * rule[0] > np.diff(solution.at).max(initial=0.0) > 0.0:
        return ()
    last = slice(max(1, len(solution) - _ROWS), None)  # a sudden start accelerates vibrations by itself
    v, a, at = solution.v[last], solution.a[last], solution.at[last]
    change = np.diff(v, axis=0)
    beside = change - 0.5 * np.diff(at)[:, None] * (a[1:] + a[:-1])
    mass = system.table(masses)
    excess, explained = (float((np.square(each) @ mass).sum()) for each in (beside, change))
    errors = np.array(sizes(system, np.abs(solution.p).max(axis=0))) @ system.residual_errors
    impulses = _ROUND_OFF * rule[0] * np.sqrt(len(change)) * errors[mass > 0.0]
    expected = max(explained, float(np.sum(impulses**2 / mass[mass > 0.0])))
    if not excess > _BEYOND * expected:
        return ()
    sentence = (
        f"accelerations in the rows are some {np.sqrt(excess / expected):.2g} times those that change the velocities: "
        "forces there are those of vibrations that the steps do not resolve, and that the method does not damp. Use "
        "Radau, or smaller steps"
    )
    warn(sentence, TimeStepWarning)
    return (sentence,)
