"""Compiled sliders on the axis of a beam: tangents by differences, and the place that Python finds."""

import numpy as np
import pytest
from slow_values import mostly_slow

from beamfem.equations.equations import linearise, residual
from beamfem.equations.system import system_of
from beamfem.linalg.tangent import UNROTATED
from tests.physics.test_slider_on_beam import ELEMENTS, pushed


@mostly_slow("elements", [4, 40])
@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_tangents_are_those_of_differences_and_the_condition_is_that_of_python(element, elements):
    """Few elements have a band with a border, 40 a sparse matrix."""
    _, found = pushed(element, 0.02, elements)
    system, rng = system_of(found.model, static=True), np.random.default_rng(1)
    free, (item,) = system.free_dofs, system.connectors.items
    for row in (5, 20, -1):
        state, still = found.p[row].copy(), np.zeros(found.model.size)
        change = still.copy()
        change[free] = rng.standard_normal(len(free)) * system.scale[free]
        tangent = linearise(system, state, still, still, found.at[row], (1.0, 0.0, 0.0))[1].sparse(UNROTATED)
        ends = [residual(system, state + h * change, still, still, found.at[row])[free] for h in (-1e-8, 1e-8)]
        exact = tangent @ change[free]
        assert (ends[1] - ends[0]) / 2e-8 == pytest.approx(exact, abs=1e-6 * np.abs(exact).max())
        state[item.dofs] += 1e-3 * rng.standard_normal(len(item.dofs))
        compiled = residual(system, state, still, still, found.at[row])[item.own[0]]
        assert item.force_in((state, still, still), 0.0, np.zeros(2))[-1] == pytest.approx(compiled, abs=1e-14)
