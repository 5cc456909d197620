"""Section laws with history that resist rates, under sudden loads: as a retardation time does, and by hand."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from connectors import PointMass, RigidLink
from history_laws import SECTION, YIELDING, Creeping, Viscous, arm

import beamfem as bf
from beamfem.equations.equations import linearise
from beamfem.equations.system import system_of
from beamfem.equations.viscosity import viscous_stiffness, viscous_tangent
from beamfem.section import StiffnessSection
from beamfem.section.law import ConstitutiveLaw
from beamfem.solve.motion.start_acceleration import initial_acceleration

TIME = 0.2
SOFT = {"axial": 1e4, "shear": 4e3, "bending": 1.0, "mass": 1e-3, "rotary_inertia": 1e-8}
LOSSY = bf.Material(1.0, 0.3, 1.0, retardation_time=TIME)
DAMPED = [(Viscous(**SOFT, retardation=TIME), None), (StiffnessSection(**SOFT), LOSSY)]
kinds = pytest.mark.parametrize(("section", "material"), DAMPED, ids=["law", "material"])
rhos = pytest.mark.parametrize("rho", [0.0, 0.5, 0.9, 1.0])


def crept(time, since=0.0):
    return np.where(time > since, 1.0 - np.exp(-np.maximum(time - since, 0.0) / TIME), 0.0)


def turned(section, material, rho, step, amplitude=None, duration=0.5):
    """A moment that turns the end by 1 rad in the end, in steps far longer than the periods of the arm."""
    given = {} if amplitude is None else {"amplitude": amplitude, "scale": False}
    beam, model = arm(section, lambda beam: [bf.PointMoment(beam.end, 1.0, **given)], material=material)
    return beam, bf.simulate(model, duration, step, integrator=bf.GeneralizedAlpha(rho))


@rhos
@pytest.mark.parametrize("step", [0.04, 0.01, 0.0025])
def test_a_viscous_law_creeps_under_a_sudden_moment(rho, step):
    """By backward differences: of first order. The load puts in 1 J, and little of it moves the light arm."""
    beam, motion = turned(*DAMPED[0], rho, step)
    assert motion.rotation(beam.end) == pytest.approx(crept(motion.at), abs=0.3 * step / TIME)
    assert motion.energy().kinetic.max() < 5e-3
    assert motion.energy().total.max() < 1e-9
    assert not motion.warnings


@rhos
def test_a_viscous_law_moves_as_a_retardation_time_does(rho):
    """The material lags by three quarters of a step at most, the law by less."""
    found = []
    for section, material in DAMPED:
        beam, motion = turned(section, material, rho, 0.005)
        found.append(motion.rotation(beam.end))
    assert found[0] == pytest.approx(found[1], abs=0.005 / TIME)


@pytest.mark.slow
@rhos
@kinds
def test_a_load_that_jumps_later_is_no_different(section, material, rho):
    jumping = bf.Piecewise(lambda time: 0.0 if time < 0.2 else 1.0 if time < 0.4 else -0.5, kinks=[0.2, 0.4])
    beam, motion = turned(section, material, rho, 0.005, jumping, duration=0.8)
    expected = crept(motion.at, 0.2) - 1.5 * crept(motion.at, 0.4)
    assert motion.rotation(beam.end) == pytest.approx(expected, abs=1.2 * 0.005 / TIME)
    assert motion.energy().kinetic.max() < 5e-3


@rhos
@kinds
def test_arms_on_a_link_creep_under_a_sudden_force(section, material, rho):
    """With the multiplier of the link, whose force is half the load."""
    one, two = (
        bf.Beam(bf.Line((0, height), (1, height)), 4, bf.CRBF(order=3), section, material) for height in (0.0, 0.5)
    )
    supports, load = [bf.Clamp(one.start), bf.Clamp(two.start)], bf.PointForce(one.end, (0.0, 0.1))
    model = bf.Model([one, two], supports, [load], connectors=[RigidLink(one.end, two.end)])
    last = bf.solve_static(model).displacement(one.end)[-1, 1]
    motion = bf.simulate(model, 0.5, 0.01, integrator=bf.GeneralizedAlpha(rho))
    assert motion.displacement(one.end)[:, 1] / last == pytest.approx(crept(motion.at), abs=0.8 * 0.01 / TIME)
    assert motion.energy().total.max() < 1e-9
    assert motion.multipliers(model.connectors[0])[1:] == pytest.approx(-0.05, rel=1e-3)


@rhos
def test_a_mass_on_a_viscous_bar_is_a_damped_oscillator(rho):
    """Mass m on k = EA / L and c = t k, suddenly loaded: 1 - exp(-z w t) (cos + z / sqrt(1 - z^2) sin)."""
    bar, mass, damping = 1e4, 4.0, 0.3
    omega = np.sqrt(bar / mass)
    section = Viscous(**{**SOFT, "axial": bar, "mass": 1e-6}, retardation=2.0 * damping / omega)
    beam, model = arm(section, lambda beam: [bf.PointForce(beam.end, (1.0, 0.0))], order=2, elements=2)
    model = replace(model, connectors=[PointMass(beam.end, mass)])
    turning = omega * np.sqrt(1.0 - damping**2)
    for step in (5e-3, 2.5e-3, 1.25e-3):
        motion = bf.simulate(model, 0.25, step, integrator=bf.GeneralizedAlpha(rho))
        swung = np.cos(turning * motion.at) + damping * omega / turning * np.sin(turning * motion.at)
        expected = 1.0 - np.exp(-damping * omega * motion.at) * swung
        # of first order, as backward differences are
        assert bar * motion.displacement(beam.end)[:, 0] == pytest.approx(expected, abs=0.2 * omega * step)


def test_only_what_resists_rates_is_damping(rng):
    """Over a step h: t C / h after Kelvin and Voigt; a law that creeps is softer, one that yields knows no time."""
    strain, step = np.array([1e-4, 1e-4, 1.0]) * rng.standard_normal((5, 3)), 1e-2
    for section in (Creeping(**SECTION, relaxation=0.3), Creeping(**SECTION, relaxation=1e-5), YIELDING):
        law = ConstitutiveLaw(section, None)
        assert not viscous_stiffness(law, strain, law.at_start(5), step).any()
    law = ConstitutiveLaw(Viscous(**SECTION, retardation=0.3), None)
    found = viscous_stiffness(law, strain, law.at_start(5), step)
    assert found == pytest.approx(np.tile(0.3 / step * law.stiffness, (5, 1, 1)), rel=1e-12)


@dataclass(frozen=True)
class OnlyBendingResists(Creeping):
    """Creeps in stretch and shear and resists the rate of curvature."""

    retardation: float = 0.5

    def resultants(self, strain, material, history, dt):
        viscous = Viscous.resultants(self, strain, material, np.tile(history, 2), dt)
        return np.column_stack([super().resultants(strain, material, history, dt)[:, :2], viscous[:, 2]])

    def _viscous(self, strain, history, dt):
        return self.retardation * self.moduli * (strain - history[:, :3]) / dt if dt > 0.0 else 0.0


def test_a_law_may_creep_in_one_strain_and_damp_another():
    law = ConstitutiveLaw(OnlyBendingResists(**SECTION, relaxation=0.3), None)
    found = viscous_stiffness(law, np.zeros((1, 3)), law.at_start(1), 1e-2)[0]
    assert found == pytest.approx(np.diag([0.0, 0.0, 0.5 * SECTION["bending"] / 1e-2]), rel=1e-12)


@pytest.mark.parametrize("element", [bf.CRBF(1), bf.CRBF(3), bf.CRBF(4), bf.BilinearCRBF(bf.Structural())])
def test_the_damping_of_a_law_is_that_of_a_retardation_time(element, rng):
    """The same matrix of the whole model, in a bent state."""
    step, seed, found = 0.03, rng.integers(1000), []
    for section, material in DAMPED:
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, section, material)
        model = bf.Model([beam], [bf.Clamp(beam.start)])
        system = system_of(model, static=False)
        p, zeros = system.reference.copy(), np.zeros(model.size)
        p[system.free_dofs] += 0.02 * np.random.default_rng(seed).standard_normal(len(system.free_dofs))
        if material is None:
            found.append(viscous_tangent(system, p, zeros, 0.0, step).toarray())
        else:
            found.append(linearise(system, p, zeros, zeros, 0.0, (0.0, step, 0.0))[1].sparse(system.rotated).toarray())
    assert np.abs(found[1]).max() > 0.0
    assert found[0] == pytest.approx(found[1], rel=1e-9, abs=1e-9 * np.abs(found[1]).max())


@pytest.mark.parametrize("law", [YIELDING, Creeping(**SECTION, relaxation=1e-3)], ids=["yields", "creeps"])
def test_the_start_of_other_laws_is_what_it_was(law):
    _, model = arm(law, lambda beam: [bf.PointForce(beam.end, (0.0, 30.0))])
    system = system_of(model, static=False)
    state = np.zeros((4, model.size))
    state[0] = system.reference
    assert np.array_equal(initial_acceleration(system, state, 0.0, 0.01), initial_acceleration(system, state, 0.0))
