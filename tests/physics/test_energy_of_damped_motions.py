"""Energy of damped motions: a rise that is warned of, and the balance of work, losses and what is kept."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from connectors import SpringDamper
from history_laws import LIGHT, SECTION, Viscous, arm

import beamfem as bf
from beamfem.section import StiffnessSection

SOFT = {"axial": 1e4, "shear": 4e3, "bending": 1.0, "mass": 1e-3, "rotary_inertia": 1e-8}
LOSSY = bf.Material(1.0, 0.3, 1.0, retardation_time=0.2)


def test_a_damped_motion_whose_energy_rises_is_warned_of(uncut_steps):
    """A fast start against strong damping, which moves on for half a step with rho_inf below 1; not so with 1."""
    _, model = arm(StiffnessSection(**SOFT), material=LOSSY)
    thrown = {"duration": 0.3, "step": 0.01, "velocity": lambda x: (0.0, x[0] ** 2)}
    with pytest.warns(bf.errors.EnergyWarning, match="rises by 0.06"):
        motion = bf.simulate(model, **thrown)
    assert motion.energy().total.max() > 100.0 * motion.energy().total[0]
    (said,) = motion.warnings
    assert said.startswith("the energy rises by 0.06")
    assert motion.energy_drift is None
    assert not bf.simulate(model, integrator=bf.GeneralizedAlpha(1.0), **thrown).warnings


@pytest.mark.parametrize("steps", [50, 301, 1500])
def test_a_rise_that_lasts_for_a_few_steps_of_many_is_warned_of(uncut_steps, steps):
    """Eightfold within two steps, after which damping takes it all: one row in three or fifteen missed it."""
    material = bf.Material(2e11, 0.3, 7800.0, retardation_time=1e-3)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.01, 0.01), material)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    with pytest.warns(bf.errors.EnergyWarning):
        motion = bf.simulate(model, steps * 1e-3, 1e-3, velocity=lambda x: (x[0], 0.0))
    energy = motion.energy().total
    assert energy.max() > 5.0 * energy[0]
    (said,) = motion.warnings
    assert said.startswith("the energy rises by")


@dataclass(frozen=True)
class Growing(StiffnessSection):
    """Its stress-free curvature grows by 1 /m in a second, which does work: a negative dissipation [J/m]."""

    memory = (0.0, 0.0)

    def resultants(self, strain, material, history, dt):
        bent = strain[:, 2] - history[:, 0] - dt
        return np.stack([self.axial * strain[:, 0], self.shear * strain[:, 1], self.bending * bent], axis=-1)

    def remember(self, strain, material, history, dt):
        mean = strain[:, 2] - history[:, 0] - 0.5 * dt
        return history + np.stack([np.full(len(strain), dt), self.bending * mean * dt], axis=-1)

    def energy(self, strain, material, history):
        bent = strain - history[:, :1] * np.array([0.0, 0.0, 1.0])
        return np.stack([0.5 * bent**2 @ np.array([self.axial, self.shear, self.bending]), history[:, 1]], axis=-1)


def test_a_law_that_drives_the_motion_is_not_warned_of():
    """It winds up a beam between clamps: by 1/2 EI k^2 L."""
    beam, model = arm(Growing(**LIGHT))
    motion = bf.simulate(replace(model, supports=[bf.Clamp(beam.start), bf.Clamp(beam.end)]), 0.5, 0.01)
    energy = motion.energy()
    assert energy.total[-1] == pytest.approx(0.5 * LIGHT["bending"] * 0.25, rel=1e-12)
    assert energy.dissipated[-1] == pytest.approx(-energy.total[-1], rel=1e-12)
    assert not motion.warnings


def balanced(motion, share=2e-3):
    """Return the energies of a motion whose work, changes and losses balance to a share of what is lost."""
    energy = motion.energy()
    assert np.abs(energy.error).max() < share * energy.dissipated[-1]
    return energy


TRAPEZOIDAL = bf.GeneralizedAlpha(1.0)


@pytest.mark.parametrize("damping", [bf.Rayleigh(mass=3.0), bf.KelvinVoigt(0.02), bf.Rayleigh(2.0, 0.01)], ids=str)
@pytest.mark.parametrize("element", [bf.CRBF(order=3), bf.ANCF(), bf.ShearRigid()], ids=lambda element: element.name)
def test_a_damped_beam_loses_the_energy_that_it_had(element, damping):
    """It starts with that of its weight, and comes to rest where statics ends: half of what its weight has done."""
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), 3, element, bf.Rectangle(0.02, 0.02), bf.Material(1e8, 0.3, 1e3), damping=damping
    )
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0, -9.81))])
    energy = balanced(bf.simulate(model, 12.0, 4e-3, TRAPEZOIDAL))
    static = bf.solve_static(model).energy()
    assert not energy.work.any()
    assert energy.dissipated[-1] == pytest.approx(-static.total[-1], rel=2e-3)
    assert np.all(np.diff(energy.dissipated) >= 0.0)
    assert np.array_equal(static.dissipated, [0.0, 0.0])


@pytest.mark.slow
def test_what_dampers_dissipate_is_integrated():
    """Beside a section with history, which records what it dissipates itself; in statics nothing has a rate."""
    push = lambda beam: [bf.PointForce(beam.end, (0.0, 5.0))]  # noqa: E731
    for section in (StiffnessSection(**SECTION), Viscous(**SECTION, retardation=0.01)):
        beam, model = arm(section, push)
        other = bf.Beam(bf.Line((0, 1), (1, 1)), 1, bf.CRBF(order=2), StiffnessSection(**SECTION))
        dashpots = SpringDamper(beam.end, other.end, 10.0, 2.0), bf.SpringDamper(beam.end, (1.0, -0.5), 10.0, 2.0)
        for dashpot in dashpots:
            damped = replace(
                model,
                beams=[*model.beams, other],
                supports=[*model.supports, bf.Clamp(other.start)],
                connectors=[dashpot],
            )
            energy = balanced(bf.simulate(damped, 0.2, 2e-4, TRAPEZOIDAL), 1e-3)
            assert np.array_equal(bf.solve_static(damped).energy().dissipated, bf.solve_static(model).energy().recorded)
            assert energy.dissipated[-1] - energy.recorded[-1] > 1e-3


def test_a_mass_on_a_damped_spring_loses_its_energy_as_by_hand():
    """Let go at rest by 1 m: k (1 m)^2 / 2 less m v^2 / 2 + k x^2 / 2 of the damped oscillator."""
    mass, stiffness, damping = 2.0, 50.0, 3.0
    thread = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, bf.CRBF(1), bf.Section.from_stiffness(1e3, 1e3, 1e-2, 1e-9, 1e-12))
    spring = bf.SpringDamper(thread.start, (0.0, -2.0), stiffness, damping, length=1.0)
    model = bf.Model(
        [thread], [bf.Roller(thread.start, (1, 0))], connectors=[spring], masses=[bf.PointMass(thread.start, mass)]
    )
    motion = bf.simulate(model, 2.0, 1e-3, TRAPEZOIDAL)
    decay, omega = damping / (2 * mass), np.sqrt(stiffness / mass)
    turn = np.sqrt(omega**2 - decay**2)
    envelope = np.exp(-decay * motion.at)
    x = envelope * (np.cos(turn * motion.at) + decay / turn * np.sin(turn * motion.at))
    v = -envelope * omega**2 / turn * np.sin(turn * motion.at)
    expected = stiffness / 2 * (1.0 - x**2) - mass / 2 * v**2
    assert motion.energy().dissipated == pytest.approx(expected, abs=1e-5 * stiffness)


def test_work_of_a_motor_like_support_is_what_is_lost_and_kept():
    """A post shaken at its base, with a damper of its own: the work of the base is in the motion, or dissipated."""
    post = bf.Beam(
        bf.Line((0, 0), (0, 1)), 3, bf.CRBF(3), bf.Rectangle(0.02, 0.02), bf.Material(1e8, 0.3, 1e3),
        damping=bf.Rayleigh(1.0, 2e-3),
    )  # fmt: skip
    shaken = bf.Prescribed(post.start, ux=lambda t: 0.05 * np.sin(5.0 * t) ** 2, uy=0.0, rotation=0.0)
    energy = balanced(bf.simulate(bf.Model([post], [shaken]), 4.0, 1e-3, TRAPEZOIDAL), 5e-3)
    assert energy.work[-1] > energy.dissipated[-1] > 0.1 * energy.work[-1]
