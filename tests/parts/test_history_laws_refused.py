"""Section laws with history that are refused: mistakes of users, and analyses that do not follow history."""

from dataclasses import dataclass

import numpy as np
import pytest
from history_laws import SECTION, YIELDING, Plastic, arm
from section_laws import LinearLaw

import beamfem as bf
from beamfem.testing import check_law


def test_what_remembers_is_refused_where_it_cannot_be_taken():
    _, model = arm(YIELDING, lambda beam: [bf.PointForce(beam.end, (-1.0, 0.0))])
    for solve in (bf.solve_buckling, bf.trace_equilibrium):
        with pytest.raises(bf.InputError, match="does not support section laws with history, such as Plastic"):
            solve(model)


def test_steps_that_fail_are_named_where_the_past_counts():
    jump = lambda at: 1e9 if at > 0.5 else 0.0  # noqa: E731
    _, model = arm(YIELDING, lambda beam: [bf.PointForce(beam.end, (0.0, 1.0), amplitude=jump)])
    with pytest.raises(
        bf.ConvergenceError, match="models with section laws that have history are not followed"
    ) as caught:
        bf.solve_static(model, steps=4, newton=bf.Newton(iterations=3))
    assert caught.value.solution.at[-1] == pytest.approx(0.5)


@dataclass(frozen=True)
class Changed(Plastic):
    """A law with a mistake."""

    mistake: str = ""

    def resultants(self, strain, material, history, dt):
        found = super().resultants(strain, material, history, dt)
        if self.mistake == "shape":
            return found[:2]
        if self.mistake == "abs":
            return np.abs(found)
        if self.mistake == "time":
            return found * (1.0 + dt)
        return np.where(np.abs(strain.real) > 1e-4, np.nan, found) if self.mistake == "nan" else found

    def remember(self, strain, material, history, dt):
        found = super().remember(strain, material, history, dt)
        if self.mistake == "length":
            return found[:, :1]
        if self.mistake == "forgets":
            return history
        return found * np.nan if self.mistake == "unknown" else found

    def energy(self, strain, material, history):
        found = super().energy(strain, material, history)
        if self.mistake == "one":
            return found[:, 0]
        return 1.1 * found if self.mistake == "energy" else found

    @property
    def beyond(self):
        return 1.0 - 1e-9 if self.mistake == "edge" else super().beyond


@pytest.mark.parametrize(
    ("mistake", "said"),
    [
        ("abs", "resultants of Changed are not analytic"),
        ("nan", "resultants of Changed must be finite and real"),
        ("time", "resultants of Changed change .* after 0.001 s when history is committed"),
        ("forgets", "energy of Changed does not belong to its resultants"),
        ("energy", "energy of Changed does not belong to its resultants"),
        ("edge", "Changed is not elastic .* at the history that remember has just returned"),
    ],
)
def test_a_law_with_a_mistake_is_found(mistake, said):
    with pytest.raises(AssertionError, match=said):
        check_law(Changed(**SECTION, limit=1e-2, hardening=25.0, mistake=mistake))


@pytest.mark.parametrize(
    ("mistake", "said"),
    [
        ("shape", r"resultants of Changed must return numbers of the shape \(\d+, 3\)"),
        ("length", r"remember of Changed must return numbers of the shape \(\d+, 2\)"),
        ("unknown", "remember of Changed must return finite numbers"),
        ("one", r"energy of Changed must return numbers of the shape \(\d+, 2\)"),
    ],
)
def test_a_law_that_returns_another_shape_is_refused(mistake, said):
    with pytest.raises(bf.InputError, match=said):
        arm(Changed(**SECTION, limit=1e-2, hardening=25.0, mistake=mistake))


def test_half_a_memory_is_refused():
    @dataclass(frozen=True)
    class Forgetful(LinearLaw):
        memory = (0.0,)

    @dataclass(frozen=True)
    class Empty(Plastic):
        memory = ()

    @dataclass(frozen=True)
    class Unsure(Plastic):
        memory = (0.0, np.nan)

    for law, said in (
        (Forgetful(**SECTION), "Forgetful has a memory or remember"),
        (Empty(**SECTION), "memory of Empty is empty"),
        (Unsure(**SECTION), "memory of Unsure must be finite"),
    ):
        with pytest.raises(bf.InputError, match=said):
            arm(law)
