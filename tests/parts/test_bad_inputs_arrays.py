"""Tables and arrays of other libraries, functions that are noise, and arrays that users' parts return."""

from dataclasses import dataclass, replace
from itertools import count

import numpy as np
import pytest

import beamfem as bf

SECTION, SOFT = bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1000.0)
BAR = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SECTION, SOFT)


def test_a_table_of_pandas_is_taken_by_its_values_and_not_by_the_names_of_its_columns():
    """`bf.Gravity(pd.DataFrame([[0, -9.81]]))` was (0, 1)."""
    pd = pytest.importorskip("pandas")
    points = pd.DataFrame({"x": [0.0, 1.0, 2.0], "y": [0.0, 1.0, 0.0]})
    assert bf.Polyline(points).points == ((0.0, 0.0), (1.0, 1.0), (2.0, 0.0))
    with pytest.raises(bf.InputError, match="vector of Gravity must be two"):
        bf.Gravity(pd.DataFrame([[0.0, -9.81]]))


def test_a_section_that_is_another_one_each_time_is_named():
    """The search for its jumps never ended."""
    calls = count()
    beam = bf.Beam(BAR.curve, 4, bf.CRBF(2), lambda s: bf.Rectangle(0.1, 0.1 + 1e-3 * (next(calls) % 7)), SOFT)
    with pytest.raises(bf.InputError, match="section of a Beam returns other values each time"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))]))


def test_a_load_that_is_noise_is_named(rng):
    load = bf.DistributedLoad(BAR, lambda s: (0.0, rng.random()))
    with pytest.raises(bf.InputError, match="vector of DistributedLoad returns other values each time"):
        bf.solve_static(bf.Model([BAR], [bf.Clamp(BAR.start)], [load]))


CHANGES = {
    "complex": lambda found: found + 0j,
    "bool": lambda found: found != 0.0,
    "masked": lambda found: np.ma.array(found, mask=found == 0.0),
    "shape": lambda found: found[..., :2],
    "nan": lambda found: found * np.nan,
    "list": lambda found: found.tolist(),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_stiffness_that_is_no_array_of_floats_is_refused(change):
    @dataclass(frozen=True)
    class Own(bf.Structural):
        def stiffness(self, *arguments):
            return change(super().stiffness(*arguments))

    beam = bf.Beam(BAR.curve, 4, bf.CRBF(2, forces=Own()), SECTION, SOFT)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
    with pytest.raises(bf.InputError, match=r"stiffness of Own must be an array \(1, 4, 4\) of finite floats"):
        bf.solve_static(model)


class Standing:
    """An integrator that returns its start."""

    def step(self, motion, begin, end):
        return begin


class Short:
    """An integrator that works in single precision."""

    def step(self, motion, begin, end):
        return replace(begin, p=begin.p.astype(np.float32), at=end)


CASES = [(Standing(), "must return the state at its end"), (Short(), "double precision")]


@pytest.mark.parametrize(("integrator", "words"), CASES)
def test_an_integrator_that_returns_another_state_than_asked_for_is_refused(integrator, words):
    model = bf.Model([BAR], [bf.Clamp(BAR.start)], [bf.Gravity((0.0, -9.81))])
    with pytest.raises(bf.InputError, match=words):
        bf.simulate(model, 0.01, 1e-3, integrator)
