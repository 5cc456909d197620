"""Integrators of one's own in a simulation: those of `integrators`, against the one of the package and balances."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from connectors import Rest, RigidLink, SpringDamper, crossbar
from history_laws import Creeping, Plastic
from integrators import EnergyMomentum, Radau
from slow_values import mostly_slow

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


@pytest.mark.slow
@mostly_slow("element", [bf.CRBF(2), bf.ANCF(), bf.BilinearCRBF()], ids=["CRBF(2)", "ANCF", "bilinear"])
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


def test_a_discrete_gradient_keeps_the_energy_of_springs():
    """Springs at points whose sections do not rotate with a connector, so that the mass stays constant."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.ANCF(), SECTION, RUBBER)
    springs = [bf.Spring(beam.start, stiffness=(3e3, 2e3)), bf.Spring(beam.end, stiffness=(30.0, 0.0))]
    model = bf.Model([beam], springs, [bf.Gravity((0.0, -9.81))])
    own, known = (bf.simulate(model, 0.2, 4e-3, integrator=own) for own in (EnergyMomentum(), bf.GeneralizedAlpha(1.0)))
    drift, other = (np.ptp(found.energy().total) / np.ptp(found.energy().kinetic) for found in (own, known))
    assert np.ptp(known.energy().potential) > 1.0
    assert drift < 1e-11
    assert other > 1e-6
    exact = bf.simulate(model, 0.2, 1e-4, integrator=bf.GeneralizedAlpha(1.0)).position(beam.end)[-1]
    errors = [np.linalg.norm(found.position(beam.end)[-1] - exact) for found in (own, known)]
    assert 0.0 < errors[0] < 2.0 * errors[1] < 5e-3


@mostly_slow(("step", "every"), [(1e-4, 10), (5e-5, 20), (2.5e-5, 40)])
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


def smooth(time):
    return 0.05 * (1.0 - np.cos(20.0 * time))


def kinked(time):
    return 0.5 * max(time - 0.05123, 0.0)


@pytest.mark.slow
@mostly_slow("moves", [smooth, kinked], quick=(1,))
@mostly_slow("directions", [("uy",), ("rotation",)], ids="-".join)
def test_supports_move_a_beam_also_where_they_start_at_once(moves, directions):
    """With a kink inside a step as well: the moved coordinate satisfies p = u at the end of each stage."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, RUBBER)
    support = bf.Prescribed(beam.start, **({"ux": 0.0, "uy": 0.0} | dict.fromkeys(directions, moves)))
    model = bf.Model([beam], [support], [bf.Gravity((0.0, -9.81))])
    known = bf.simulate(model, 0.2, 2.5e-5, integrator=bf.GeneralizedAlpha(1.0), save_every=400)
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        own = bf.simulate(model, 0.2, step, integrator=Radau(), save_every=round(0.01 / step))
        errors.append(np.linalg.norm(own.position(beam.end)[-1] - known.position(beam.end)[-1]))
        led = own.displacement(beam.start)[:, 1] if directions == ("uy",) else own.rotation(beam.start)
        assert led == pytest.approx([moves(time) for time in own.time], abs=1e-13)
    assert errors[2] < errors[0] / 10.0
    assert errors[2] < 2e-6
    assert own.reaction(beam.start)[-1] == pytest.approx(known.reaction(beam.start)[-1], rel=5e-3, abs=1e-12)


@pytest.mark.slow
def test_a_point_that_goes_along_a_line_carries_its_momentum():
    """The support of a stiff pendulum is led with constant velocity: seen from there, it is at rest or falls."""
    beam, still = pendulum(bf.CRBF(2))
    led = bf.Prescribed(beam.start, ux=lambda time: 3.0 * time, uy=0.0)
    motions = [
        bf.simulate(bf.Model([beam], [support], still.loads), 0.2, 1e-3, integrator=Radau(), velocity=velocity)
        for support, velocity in ((still.supports[0], None), (led, bf.RigidVelocity((3.0, 0.0))))
    ]
    along = motions[1].position(beam.end) - 3.0 * motions[1].time[:, None] * np.array([1.0, 0.0])
    assert along == pytest.approx(motions[0].position(beam.end), abs=1e-9)


@pytest.mark.slow
@mostly_slow("turn", [0.0, 0.3], quick=(1,))
def test_conditions_of_a_link_hold(turn):
    """The multiplier of a step satisfies the condition at its end; velocities stay along the condition too."""
    two, model = crossbar(RigidLink, turn)
    known = bf.simulate(model, 0.3, 5e-5, integrator=bf.GeneralizedAlpha(0.9), save_every=600)
    own = bf.simulate(model, 0.3, 1e-3, integrator=Radau(), save_every=30)
    ends = [own.position(point) for point in model.connectors[0].points]
    assert np.linalg.norm(ends[1] - ends[0], axis=1) == pytest.approx(np.full(len(own), 0.5), abs=1e-12)
    assert own.position(two.end) == pytest.approx(known.position(two.end), abs=2e-6)
    rates = [own.velocity(point) for point in model.connectors[0].points]
    assert np.sum((ends[1] - ends[0]) * (rates[1] - rates[0]), axis=1) == pytest.approx(np.zeros(len(own)), abs=1e-9)


@pytest.mark.slow
def test_a_stop_with_friction_slides_and_remembers():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, RUBBER)
    rest = Rest(beam.end, -1e-3, 2e3, 0.2)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))], connectors=[rest])
    known = bf.simulate(model, 0.4, 5e-5, integrator=bf.GeneralizedAlpha(0.8), save_every=400)
    own = bf.simulate(model, 0.4, 1e-3, integrator=Radau(), save_every=20)
    assert own.position(beam.end) == pytest.approx(known.position(beam.end), abs=3e-5)
    slip = [motion.p[:, model.coordinates :] for motion in (own, known)]
    assert np.ptp(slip[0]) > 1e-4
    assert slip[0] == pytest.approx(slip[1], abs=3e-5)


@pytest.mark.slow
@mostly_slow(
    "section",
    [
        Plastic(1e3, 4e2, 0.83, 2.0, 1e-3, limit=0.25, hardening=0.1),
        Creeping(1e3, 4e2, 0.83, 2.0, 1e-3, relaxation=0.5),
    ],
    ids=lambda section: type(section).__name__,
)
def test_laws_with_history_are_committed_once_a_step(section):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), section)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -0.3))])
    known = bf.simulate(model, 0.8, 1e-4, save_every=400)
    errors = []
    for step in (4e-3, 2e-3):
        own = bf.simulate(model, 0.8, step, integrator=Radau(), save_every=round(0.04 / step))
        errors.append(np.abs(own.position(beam.end) - known.position(beam.end)).max())
    assert np.ptp(known.position(beam.end)[:, 1]) > 0.1
    assert errors[1] < 0.6 * errors[0]
    assert errors[1] < 5e-3


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


def test_what_is_no_integrator_is_refused():
    _, model = pendulum(bf.CRBF(2))
    for wrong in (Radau, "radau", 0.9):
        with pytest.raises(bf.InputError, match=r"GeneralizedAlpha\(rho_inf=...\), an object with rule\(step\)"):
            bf.simulate(model, 0.1, 1e-2, integrator=wrong)


def test_what_a_step_raises_names_the_integrator_and_the_time():
    class Broken:
        def step(self, motion, begin, end):
            return {}["x"] if end > 0.002 else replace(begin, at=end)

    _, model = pendulum(bf.CRBF(2))
    with pytest.raises(KeyError, match="'x'") as caught:
        bf.simulate(model, 0.01, 1e-3, integrator=Broken())
    assert caught.value.__notes__[0] == "raised by step of Broken, in the step to 0.003 s"


@pytest.mark.parametrize(
    ("left", "move", "options", "said"),
    [
        (lambda left: left[:-1], lambda change: change, {}, "linearise must return left-hand sides"),
        (lambda left: left[:, None], lambda change: change, {}, "linearise must return left-hand sides"),
        (lambda left: left, lambda change: change[:0], {}, "move must return how much p changes"),
        (lambda left: left, lambda change: change.T, {}, "move must return how much p changes"),
        (lambda left: left, lambda change: change, {"iterations": 0}, "iterations"),
        (lambda left: left, lambda change: change, {"tolerance": -1.0}, "tolerance"),
    ],
)
def test_wrong_shapes_in_an_iteration_are_named(left, move, options, said):
    class Wrong:
        def step(self, motion, begin, end):
            def linearise():
                state = begin.p, begin.v, begin.a, end
                return left(motion.residual(*state)), [[motion.tangent(*state, (1.0, 0.0, 1.0))]]

            motion.iterate(linearise, move, **options)
            return replace(begin, at=end)

    _, model = pendulum(bf.CRBF(2))
    with pytest.raises(bf.InputError, match=said):
        bf.simulate(model, 0.01, 1e-3, integrator=Wrong())
