"""Integrators of one's own in a simulation: those of `integrators`, against the one of the package and balances."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from connectors import RigidLink, SpringDamper
from integrators import EnergyMomentum, Radau

import beamfem as bf

RUBBER = bf.Material(5e5, 0.0, 1000.0)
SECTION = bf.Rectangle(0.02, 0.1)


def pendulum(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, SECTION, RUBBER)
    return beam, bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF()], ids=["CRBF(2)", "ANCF"])
def test_radau_is_of_third_order(element):
    """A force that begins smoothly: what begins at once excites modes that no step resolves."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, element, SECTION, RUBBER)
    pull = bf.PointForce(beam.end, (0.0, -60.0), amplitude=lambda time: np.sin(40.0 * time) ** 4)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [pull])
    tips = [bf.simulate(model, 0.04, h, integrator=Radau()).position(beam.end)[-1] for h in (2e-3, 1e-3, 5e-4)]
    ratio = np.linalg.norm(tips[0] - tips[1]) / np.linalg.norm(tips[1] - tips[2])
    assert 2.8 < np.log2(ratio) < 3.2


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF(), bf.BilinearCRBF()], ids=["CRBF(2)", "ANCF", "bilinear"])
def test_radau_comes_to_where_generalized_alpha_comes(element):
    beam, model = pendulum(element)
    own = bf.simulate(model, 0.3, 1e-3, integrator=Radau(), save_every=30)
    known = bf.simulate(model, 0.3, 5e-5, integrator=bf.GeneralizedAlpha(1.0), save_every=600)
    assert own.time == pytest.approx(known.time)
    assert own.position(beam.end) == pytest.approx(known.position(beam.end), abs=2e-5)
    assert own.rotation(beam.end) == pytest.approx(known.rotation(beam.end), abs=1e-4)
    assert own.reaction(beam.start)[-1] == pytest.approx(known.reaction(beam.start)[-1], rel=2e-2, abs=0.05)


def test_a_discrete_gradient_keeps_the_energy():
    """The trapezoidal rule, of the same order, does not."""
    beam, model = pendulum(bf.ANCF())
    own, known = (bf.simulate(model, 0.2, 4e-3, integrator=own) for own in (EnergyMomentum(), bf.GeneralizedAlpha(1.0)))
    drift, other = (np.ptp(found.energy().total) / np.ptp(found.energy().kinetic) for found in (own, known))
    assert drift < 1e-11
    assert other > 1e-6
    exact = bf.simulate(model, 0.2, 1e-4, integrator=bf.GeneralizedAlpha(1.0)).position(beam.end)[-1]
    errors = [np.linalg.norm(found.position(beam.end)[-1] - exact) for found in (own, known)]
    assert 0.0 < errors[0] < 1.2 * errors[1] < 1e-3


@pytest.mark.parametrize(("step", "every"), [(1e-4, 10), (5e-5, 20), (2.5e-5, 40)])
def test_inclined_rollers_dashpots_and_kinks_of_loads_are_taken(step, every):
    """Short steps stay with those of order 3: extrapolated by seven differences they drifted by 2e-4, the more the
    shorter, since what iterations leave came back enlarged."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, RUBBER)
    other = bf.Beam(bf.Line((0, -0.5), (1, -0.5)), 2, bf.CRBF(2), SECTION, RUBBER)
    pulse = bf.Piecewise(lambda time: max(1.0 - abs(time / 0.0305 - 1.0), 0.0), (0.0305, 0.061))
    model = bf.Model(
        [beam, other],
        [bf.Pin(beam.start), bf.Roller(beam.end, normal=(-0.6, 0.8)), bf.Clamp(other.start)],
        [bf.PointForce(beam.at(0.5), (0.0, -20.0), amplitude=pulse)],
        connectors=[SpringDamper(beam.end, other.end, damping=30.0)],
    )
    own = bf.simulate(model, 0.1, 1e-3, integrator=Radau())
    known = bf.simulate(model, 0.1, step, integrator=bf.GeneralizedAlpha(1.0), save_every=every)
    for point in (beam.at(0.5), beam.end, other.end):
        assert own.position(point) == pytest.approx(known.position(point), abs=3e-6)
    moved = own.displacement(beam.end)
    assert moved @ np.array([-0.6, 0.8]) == pytest.approx(np.zeros(len(own)), abs=1e-12)
    assert np.abs(moved).max() > 1e-3


def test_a_motion_goes_on_where_it_ended():
    beam, model = pendulum(bf.CRBF(2))
    whole = bf.simulate(model, 0.1, 2e-3, integrator=Radau())
    first = bf.simulate(model, 0.05, 2e-3, integrator=Radau())
    second = bf.simulate(model, 0.05, 2e-3, integrator=Radau(), start=first[-1])
    assert 2 * 25 <= first.statistics.iterations < 6 * 25
    assert second.position(beam.end)[-1] == pytest.approx(whole.position(beam.end)[-1], abs=1e-9)


@dataclass
class Failing:
    """Takes a few steps with another integrator, then does something else."""

    then: object
    good: int = 3

    def step(self, motion, begin, end):
        self.good -= 1
        return Radau().step(motion, begin, end) if self.good >= 0 else self.then(begin)


def _raise(error):
    raise error


@pytest.mark.parametrize(
    ("then", "said"),
    [
        (lambda begin: _raise(bf.ConvergenceError("no state there")), "from 0.006 s to 0.008 s .*: no state there"),
        (lambda begin: replace(begin, p=np.full_like(begin.p, np.inf)), "finite"),
        (lambda begin: begin.p, "step of Failing .* State"),
    ],
)
def test_a_step_that_fails_keeps_what_is_before(then, said):
    beam, model = pendulum(bf.CRBF(2))
    with pytest.raises(bf.BeamfemError, match=said) as caught:
        bf.simulate(model, 0.1, 2e-3, integrator=Failing(then))
    assert len(caught.value.solution) == 4
    known = bf.simulate(model, 0.006, 2e-3, integrator=Radau())
    assert caught.value.solution.position(beam.end) == pytest.approx(known.position(beam.end), abs=1e-14)


def test_what_own_integrators_do_not_take_is_refused():
    beam, model = pendulum(bf.CRBF(2))
    for wrong in (Radau, "radau", 0.9):
        with pytest.raises(bf.InputError, match=r"GeneralizedAlpha\(rho_inf=...\), an object with rule\(step\)"):
            bf.simulate(model, 0.1, 1e-2, integrator=wrong)
    shaken = bf.Model([beam], [bf.Pin(beam.start), bf.Prescribed(beam.end, uy=lambda time: 0.01 * time)])
    with pytest.raises(bf.InputError, match="is moved, which user-defined integrators do not support"):
        bf.simulate(shaken, 0.1, 1e-2, integrator=Radau())
    linked = bf.Model([beam], [bf.Pin(beam.start)], connectors=[RigidLink(beam.at(0.5), beam.end)])
    with pytest.raises(bf.InputError, match="unknowns of their own"):
        bf.simulate(linked, 0.1, 1e-2, integrator=Radau())


def test_what_a_step_raises_names_the_integrator_and_the_time():
    class Broken:
        def step(self, motion, begin, end):
            return {}["x"] if end > 0.002 else replace(begin, at=end)

    _, model = pendulum(bf.CRBF(2))
    with pytest.raises(KeyError, match="'x'") as caught:
        bf.simulate(model, 0.01, 1e-3, integrator=Broken())
    assert caught.value.__notes__[0] == "raised by step of Broken, in the step to 0.003 s"
