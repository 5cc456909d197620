"""Energy of damped motions: a rise that is warned of, and dissipation that is nan where it is not known."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from connectors import SpringDamper
from history_laws import LIGHT, SECTION, Viscous, arm

import beamfem as bf
from beamfem.section import StiffnessSection

SOFT = {"axial": 1e4, "shear": 4e3, "bending": 1.0, "mass": 1e-3, "rotary_inertia": 1e-8}
LOSSY = bf.Material(1.0, 0.3, 1.0, retardation_time=0.2)


def test_a_damped_motion_whose_energy_rises_is_warned_of():
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
def test_a_rise_that_lasts_for_a_few_steps_of_many_is_warned_of(steps):
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


def test_what_dampers_dissipate_is_not_known():
    """Neither is 0 J, nor does what a section with history tells stand for all of it; in statics nothing has a rate."""
    push = lambda beam: [bf.PointForce(beam.end, (0.0, 5.0))]  # noqa: E731
    beam, lossy = arm(StiffnessSection(**SECTION), push, material=replace(LOSSY, retardation_time=0.01))
    assert np.isnan(bf.simulate(lossy, 0.01, 1e-3).energy().dissipated).all()
    assert np.array_equal(bf.solve_static(lossy).energy().dissipated, [0.0, 0.0])
    for section, told in ((StiffnessSection(**SECTION), 0.0), (Viscous(**SECTION, retardation=0.01), 1e-3)):
        beam, model = arm(section, push)
        assert bf.simulate(model, 0.1, 1e-3).energy().dissipated[-1] >= told
        other = bf.Beam(bf.Line((0, 1), (1, 1)), 1, bf.CRBF(order=2), StiffnessSection(**SECTION))
        dashpot = replace(
            model,
            beams=[*model.beams, other],
            supports=[*model.supports, bf.Clamp(other.start)],
            connectors=[SpringDamper(beam.end, other.end, 10.0, 2.0)],
        )
        energy = bf.simulate(dashpot, 0.01, 1e-3).energy()
        assert np.isnan(energy.dissipated).all()
        assert np.isfinite(energy.total).all()
