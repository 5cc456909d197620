"""Energy-momentum steps: what they conserve, at any step, and that they converge with second order."""

import numpy as np
import pytest

import beamfem as bf

RUBBER = bf.Material(0.7e6, 0.3, 5540.0)
STRIP, STEEL = bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0)
PRINTED = bf.Section(area=1.6e-3, second_moment=8.533e-6)
GRADIENTS = [
    bf.BilinearANCF(),
    bf.BilinearANCF(bf.Structural()),
    bf.ANCF(integration="lobatto"),
    bf.ANCF(bf.SplitContinuum()),
]
ROTATIONS = [bf.CRBF(1), bf.CRBF(2), bf.CRBF(3), bf.BilinearCRBF(), bf.ANCFCRBF()]
named = {"ids": lambda element: f"{element.name}-{element.forces.name}"}


def pendulum(element):
    arm = bf.Beam(bf.Line((0, 0), (1.2, 0)), 4, element, PRINTED, RUBBER)
    return arm, bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))])


def drift(motion):
    energy = motion.energy()
    return np.ptp(energy.total) / np.ptp(energy.kinetic)


@pytest.mark.filterwarnings("ignore::beamfem.errors.LockingWarning", "ignore::beamfem.errors.LargeStrainWarning")
@pytest.mark.parametrize("element", GRADIENTS + ROTATIONS, **named)
def test_energy_of_a_pendulum_is_kept(element):
    arm, model = pendulum(element)
    del arm
    bound = 1e-11 if element in GRADIENTS else 1e-7  # angular velocities differ from the rates of directors
    for step in (2e-3, 2e-2):
        motion = bf.simulate(model, 40 * step, step, integrator=bf.EnergyMomentum())
        assert drift(motion) < (bound if step < 1e-2 or element in GRADIENTS else 1e-3)


def test_drift_of_rotations_does_not_accumulate():
    arm, model = pendulum(bf.CRBF(1))
    del arm
    motion = bf.simulate(model, 4.0, 5e-3, integrator=bf.EnergyMomentum())
    total = motion.energy().total
    first, last = np.ptp(total[:200]), np.ptp(total[-200:])
    assert last < 3.0 * first < 1e-6 * np.ptp(motion.energy().kinetic)


def thrown(element, section, material, bend, step):
    """A beam that is bent by a force, released and thrown."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, section, material)
    clamped = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, bend))])
    velocity = bf.RigidVelocity((1.0, 0.5), angular=3.0)
    start = bf.solve_static(clamped)
    return bf.simulate(
        bf.Model([beam]), 100 * step, step, integrator=bf.EnergyMomentum(), start=start, velocity=velocity
    )


def test_momenta_and_energy_of_a_flying_steel_strip_are_kept_at_large_steps():
    motion = thrown(bf.BilinearANCF(bf.Structural()), STRIP, STEEL, 1.5 * 2.1e11 * 0.02 * 0.002**3 / 12, 1e-3)
    linear, angular = motion.linear_momentum(), motion.angular_momentum()
    np.testing.assert_allclose(linear, np.broadcast_to(linear[0], linear.shape), rtol=1e-9)
    np.testing.assert_allclose(angular, angular[0], rtol=1e-9)
    assert drift(motion) < 1e-9


def test_a_flying_soft_beam_with_rotations_keeps_its_momenta():
    motion = thrown(bf.CRBF(2), PRINTED, RUBBER, 0.5, 1e-3)
    linear, angular = motion.linear_momentum(), motion.angular_momentum()
    np.testing.assert_allclose(linear, np.broadcast_to(linear[0], linear.shape), rtol=1e-9)
    np.testing.assert_allclose(angular, angular[0], rtol=1e-7)
    assert drift(motion) < 1e-6


def test_a_steel_strip_with_rotations_flies_at_steps_that_resolve_no_vibration():
    motion = thrown(bf.CRBF(2), STRIP, STEEL, 1.5 * 2.1e11 * 0.02 * 0.002**3 / 12, 1e-3)
    assert len(motion) == 101
    assert drift(motion) < 5e-3  # of the kinetic energy in angular velocities; that of directors is kept


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.BilinearANCF(bf.Structural())], **named)
def test_second_order(element):
    rubber = bf.Material(5e5, 0.0, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, bf.Rectangle(0.02, 0.1), rubber)
    push = bf.PointForce(beam.end, (0.0, -60.0), amplitude=lambda t: float(np.sin(40.0 * t) ** 8))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [push])
    exact = bf.simulate(model, 0.04, 1e-3, integrator=bf.Gauss(3)).position(beam.end)[-1]
    errors = [
        np.linalg.norm(bf.simulate(model, 0.04, step, integrator=bf.EnergyMomentum()).position(beam.end)[-1] - exact)
        for step in (2e-3, 1e-3, 5e-4)
    ]
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2.0, abs=0.2)


def test_springs_masses_hinges_and_inclined_clamps_are_kept_too():
    rods = [bf.Beam(bf.Line((x, 0), (x + 0.5, 0.1)), 2, bf.BilinearANCF(), PRINTED, RUBBER) for x in (0.0, 0.5)]
    rods[1] = bf.Beam(bf.Line((0.5, 0.1), (1.0, 0.1)), 2, bf.BilinearANCF(), PRINTED, RUBBER)
    hinge, gravity = bf.Hinge(rods[0].end, rods[1].start), bf.Gravity((0, -9.81))
    supports = [bf.Clamp(rods[0].start), bf.Spring(rods[1].end, stiffness=(100.0, 300.0))]
    model = bf.Model(rods, supports, [gravity], joints=[hinge], masses=[bf.PointMass(rods[1].end, 2.0)])
    assert drift(bf.simulate(model, 0.4, 1e-2, integrator=bf.EnergyMomentum())) < 1e-11


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"element": bf.ShearRigid()}, "nodes that do not shear"),
        ({"element": bf.ANCF(bf.ElasticLine())}, "ElasticLine forces"),
        ({"material": bf.Material(0.7e6, 0.3, 5540.0, retardation_time=1e-3)}, "damping of beams"),
        ({"connector": lambda arm: bf.RigidBody(arm.end, 1.0, 0.1, (0.1, 0.0))}, "the inertia of RigidBody"),
        ({"moved": True}, "supports that move"),
    ],
)
def test_what_is_not_conserved_is_refused(change, why):
    arm = bf.Beam(
        bf.Line((0, 0), (1.2, 0)), 2, change.get("element", bf.CRBF(2)), PRINTED, change.get("material", RUBBER)
    )
    turned = bf.Prescribed(arm.start, ux=0.0, uy=0.0, rotation=lambda t: t**3)
    connectors = [change["connector"](arm)] if "connector" in change else []
    model = bf.Model([arm], [turned if "moved" in change else bf.Pin(arm.start)], connectors=connectors)
    with pytest.raises(bf.InputError, match=f"EnergyMomentum is not for {why}"):
        bf.simulate(model, 0.01, 1e-3, integrator=bf.EnergyMomentum())
