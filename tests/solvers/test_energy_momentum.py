"""Energy-momentum steps: what they conserve, at any step, and that they converge with second order."""

import numpy as np
import pytest
from conftest import ELEMENTS as ALL_ELEMENTS
from conftest import FIELDS

import beamfem as bf

RUBBER, STIFF_RUBBER = bf.Material(0.7e6, 0.3, 5540.0), bf.Material(7e6, 0.3, 5540.0)
STRIP, STEEL = bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0)
PRINTED = bf.Section(area=1.6e-3, second_moment=8.533e-6)
ELEMENTS = [
    bf.BilinearANCF(),
    bf.BilinearANCF(bf.Structural()),
    bf.ANCF(integration="lobatto"),
    bf.ANCF(bf.SplitContinuum()),
    bf.ANCF(bf.ElasticLine()),
    bf.CRBF(1),
    bf.CRBF(2),
    bf.CRBF(3),
    bf.BilinearCRBF(),
    bf.ANCFCRBF(),
    bf.ShearRigid(),
    bf.Element(bf.Cubic(), bf.Rotation(), bf.ElasticLine()),
    bf.Element(bf.Cubic(), bf.ShearFree(), bf.ElasticLine()),
    bf.Element(bf.Cubic(), bf.ShearFree(stretchable=False), bf.ElasticLine()),
]
EACH = pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: f"{element.name}-{element.forces.name}")
quiet = pytest.mark.filterwarnings("ignore::beamfem.errors.LockingWarning", "ignore::beamfem.errors.LargeStrainWarning")


def pendulum(element, material=RUBBER):
    arm = bf.Beam(bf.Line((0, 0), (1.2, 0)), 4, element, PRINTED, material)
    return bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))])


def drift(motion):
    energy = motion.energy()
    return np.ptp(energy.total) / np.ptp(energy.kinetic)


def require_conserved(motion, accuracy):
    linear, angular, total = motion.linear_momentum(), motion.angular_momentum(), motion.energy().total
    for values in (linear, angular, total):
        assert np.abs(values - values[0]).max() < accuracy * np.abs(values).max()


@quiet
@EACH
def test_energy_of_a_pendulum_is_kept(element):
    for step in (2e-3, 2e-2):
        assert drift(bf.simulate(pendulum(element), 40 * step, step, integrator=bf.EnergyMomentum())) < 1e-13


@quiet
@EACH
def test_energy_and_momenta_of_a_soft_beam_that_is_bent_and_thrown_are_kept(element):
    for step in (1e-3, 1e-2):
        require_conserved(thrown(element, PRINTED, RUBBER, 0.5, step, 40), 1e-13)


@quiet
@pytest.mark.parametrize("field", FIELDS, ids=lambda field: field.name)
def test_energy_and_momenta_of_every_combination_are_kept(field):
    for element in ALL_ELEMENTS:
        if element.field == field:
            arc = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 1.0), 3, element, PRINTED, RUBBER)
            velocity = bf.RigidVelocity((1.0, 0.5), angular=6.0)
            motion = bf.simulate(bf.Model([arc]), 0.05, 1e-2, bf.EnergyMomentum(), velocity=velocity)
            require_conserved(motion, 1e-13)
            assert motion.statistics.rejected == 0


@quiet
@EACH
@pytest.mark.parametrize("step", [1e-3, 1e-2])
@pytest.mark.parametrize("steps", [pytest.param(100_000, marks=pytest.mark.slow)])
def test_they_are_kept_over_long_times(element, step, steps):
    """The energy of the soft pendulum suffices to fold an elastic line back on itself, which resists it by EA alone."""
    require_conserved(thrown(element, PRINTED, RUBBER, 0.5, step, steps), 1e-9)
    model = pendulum(element, STIFF_RUBBER if isinstance(element.forces, bf.ElasticLine) else RUBBER)
    assert drift(bf.simulate(model, steps * step, step, bf.EnergyMomentum(), save_every=100)) < 1e-9


@quiet
@pytest.mark.parametrize(("element", "angular", "step"), [(bf.CRBF(1), 200.0, 0.03), (bf.CRBF(2), 20.0, 0.1)])
def test_sections_do_not_turn_by_half_a_turn_in_a_step(element, angular, step):
    """Their mean directors would vanish, with the equations that keep energy and momenta."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, PRINTED, RUBBER)
    spin = bf.RigidVelocity((1.0, 0.5), angular=angular)
    motion = bf.simulate(bf.Model([beam]), 30 * step, step, bf.EnergyMomentum(), velocity=spin)
    require_conserved(motion, 1e-9)


@quiet
@pytest.mark.parametrize("element", [bf.CRBF(1), bf.ShearRigid()], ids=lambda element: element.name)
def test_they_are_kept_over_2000_steps(element):
    require_conserved(thrown(element, PRINTED, RUBBER, 0.5, 1e-2, 2000), 1e-11)


def thrown(element, section, material, bend, step, steps):
    """A beam that is bent by a force, released and thrown."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, section, material)
    clamped = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, bend))])
    velocity, start, every = bf.RigidVelocity((0.1, 0.05), angular=3.0), bf.solve_static(clamped), max(1, steps // 1000)
    return bf.simulate(bf.Model([beam]), steps * step, step, bf.EnergyMomentum(), start, velocity, every)


@quiet
@EACH
def test_a_steel_strip_flies_at_steps_that_resolve_no_vibration(element):
    motion = thrown(element, STRIP, STEEL, 1.5 * 2.1e11 * 0.02 * 0.002**3 / 12, 1e-3, 50)
    require_conserved(motion, 1e-9)


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.BilinearANCF(bf.Structural()), bf.ShearRigid()])
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


def joined(first, second, joint):
    rods = [
        bf.Beam(bf.Line((0, 0), (0.5, 0.1)), 2, first, PRINTED, RUBBER),
        bf.Beam(bf.Line((0.5, 0.1), (0.8, 0.6)), 2, second, PRINTED, RUBBER),
    ]
    spring, bed = bf.Spring(rods[1].end, stiffness=(100.0, 300.0)), bf.Foundation(rods[1], (20.0, 50.0))
    loads = [bf.Gravity((0, -9.81)), bf.PointForce(rods[1].end, (1.0, 2.0)), bf.DistributedLoad(rods[0], (1.0, 3.0))]
    mass = bf.PointMass(rods[1].end, 2.0)
    supports = [bf.Clamp(rods[0].start), spring, bed]
    return bf.Model(rods, supports, loads, joints=[joint(rods[0].end, rods[1].start)], masses=[mass])


@quiet
@pytest.mark.parametrize("joint", [bf.Hinge, bf.Rigid])
@pytest.mark.parametrize(
    ("first", "second"),
    [
        (bf.BilinearANCF(), bf.BilinearANCF()),
        (bf.CRBF(2), bf.ANCF()),
        (bf.ANCF(bf.ElasticLine()), bf.CRBF(2)),
        (bf.ShearRigid(), bf.ShearRigid()),
    ],
    ids=lambda element: element.name,
)
def test_energy_of_joined_beams_with_springs_foundations_dead_loads_and_masses_is_kept(first, second, joint):
    assert drift(bf.simulate(joined(first, second, joint), 0.2, 1e-2, integrator=bf.EnergyMomentum())) < 1e-12


@quiet
@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ShearRigid(), bf.BilinearANCF()], ids=lambda element: element.name)
def test_energy_on_an_inclined_roller_is_kept(element):
    arm = bf.Beam(bf.Line((0, 0), (1.0, 0.2)), 3, element, PRINTED, RUBBER)
    model = bf.Model([arm], [bf.Pin(arm.start), bf.Roller(arm.end, (1.0, 1.0))], [bf.Gravity((0, -9.81))])
    assert drift(bf.simulate(model, 0.2, 1e-2, integrator=bf.EnergyMomentum())) < 1e-12


@quiet
@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ShearRigid(), bf.ANCF()], ids=lambda element: element.name)
def test_rigid_bodies_keep_energy_and_momenta_and_move_as_they_should(element):
    arm = bf.Beam(bf.Line((0, 0), (1.2, 0.3)), 3, element, PRINTED, RUBBER)
    bodies = [bf.RigidBody(arm.end, 1.0, 0.1, (0.1, -0.05)), bf.RigidBody(arm.at(0.5), 1.0, 0.02)]
    thrown = {"duration": 0.1, "velocity": bf.RigidVelocity((1.0, 0.5), angular=5.0)}
    motion, fine = (
        bf.simulate(bf.Model([arm], masses=bodies), step=step, integrator=integrator, **thrown)
        for step, integrator in ((2e-3, bf.EnergyMomentum()), (1e-3, bf.Radau(3)))
    )
    require_conserved(motion, 1e-13)
    np.testing.assert_allclose(motion.position(arm.end)[-1], fine.position(arm.end)[-1], atol=3e-5)
    falling = bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))], masses=bodies)
    assert drift(bf.simulate(falling, 0.2, 1e-2, integrator=bf.EnergyMomentum())) < 1e-13


def test_a_ring_keeps_energy_and_what_cannot_move_stays():
    corners = [(np.cos(angle), np.sin(angle)) for angle in np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)]
    sides = [
        bf.Beam(bf.Line(a, b), 2, bf.CRBF(2), PRINTED, RUBBER)
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    joints = [bf.Rigid(a.end, b.start) for a, b in zip(sides, sides[1:] + sides[:1], strict=True)]
    ring = bf.Model(sides, joints=joints)
    motion = bf.simulate(ring, 0.1, 1e-2, bf.EnergyMomentum(), velocity=lambda x: (x[0], -2 * x[1]))
    assert drift(motion) < 1e-13
    held = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), PRINTED, RUBBER)
    model = bf.Model([held], [bf.Clamp(held.start), bf.Clamp(held.end)], [bf.Gravity((0, -9.81))])
    motion = bf.simulate(model, 0.01, 1e-3, bf.EnergyMomentum())
    assert np.ptp(motion.p, axis=0).max() == 0.0


@quiet
@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ShearRigid(), bf.ANCF()], ids=lambda element: element.name)
def test_a_curved_beam_with_its_mass_off_the_axis_keeps_energy_and_momenta(element):
    light, heavy = bf.Layer(bf.Material(5e5, 0.3, 500.0), 0.02), bf.Layer(bf.Material(1e6, 0.3, 5000.0), 0.02)
    arc = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2.0), 4, element, bf.Layered((light, heavy), 0.02))
    velocity = bf.RigidVelocity((1.0, 0.5), angular=5.0)
    require_conserved(bf.simulate(bf.Model([arc]), 0.4, 1e-2, bf.EnergyMomentum(), velocity=velocity), 1e-13)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"material": bf.Material(0.7e6, 0.3, 5540.0, retardation_time=1e-3)}, "damping of beams"),
        ({"connector": lambda arm: bf.Link(arm.start, arm.end)}, "conditions with multipliers"),
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
