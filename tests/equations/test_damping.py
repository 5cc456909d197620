"""Damping after Kelvin and Voigt: resultants C (eps + t eps')."""

import numpy as np
import pytest
from conftest import USUAL, beam, identify
from integrators import Radau
from section_laws import RambergOsgood
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import linearise, residual
from beamfem.equations.system import system_of
from beamfem.results.postprocess import strain_energies

TIME = 0.02


def damped(element, time=TIME, **given):
    plain = beam(element, **given)
    material = bf.Material(0.7e6, 0.3, 5540.0, retardation_time=time)
    return bf.Beam(plain.curve, plain.elements, element, plain.section, material)


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_the_power_of_damping_is_that_of_the_rates_of_strains(element, rng):
    """At rest p' . f is t eps'.C eps', and 2 W = h^2 eps'.C eps' of the strain energy at p + h p'."""
    own = damped(element)
    model = bf.Model([own])
    system = system_of(model, static=False)
    p, v, zeros = system.reference, rng.standard_normal(model.size), np.zeros(model.size)
    viscous = residual(system, p, v, zeros, 0.0) - residual(undamped(own), p, v, zeros, 0.0)
    h = 1e-5
    energy = sum(strain_energies(model.meshes[0], np.array([p + sign * h * v]))[0, 0] for sign in (1, -1))
    assert v @ viscous == pytest.approx(TIME * energy / h**2, rel=1e-6)


def undamped(own):
    material = bf.Material(own.material.youngs_modulus, own.material.poisson_ratio, own.material.density)
    return system_of(bf.Model([bf.Beam(own.curve, own.elements, own.element, own.section, material)]), static=False)


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_the_tangent_knows_the_force_of_damping(element, rng):
    """Its derivative by p' is exact; by p where nothing moves."""
    model = bf.Model([damped(element)])
    system = system_of(model, static=False)
    p = system.reference + 0.02 * rng.standard_normal(model.size)
    zeros, free = np.zeros(model.size), system.free_dofs
    turned = np.empty(0, dtype=np.int64), np.empty((0, 2))
    h, step = 1e-5, rng.standard_normal(model.size)
    by_rate = residual(system, p, h * step, zeros, 0.0) - residual(system, p, -h * step, zeros, 0.0)
    by_place = residual(system, p + h * step, zeros, zeros, 0.0) - residual(system, p - h * step, zeros, zeros, 0.0)
    for ck, cv in ((0.3, 0.7), (0.0, 0.7), (0.3, 0.0)):
        own = linearise(system, p, zeros, zeros, 0.0, (ck, cv, 0.0))[1].sparse(turned) @ step[free]
        found = (ck * by_place + cv * by_rate)[free] / (2 * h)
        assert own == pytest.approx(found, rel=1e-5, abs=1e-5 * np.abs(found).max())


@pytest.mark.parametrize("element", [bf.CRBF(order=2), bf.ANCF(), bf.ANCFCRBF(), bf.BilinearCRBF()], ids=identify)
def test_a_rigid_motion_is_not_damped(element):
    own = damped(element, time=1.0)
    model = bf.Model([own])
    start = bf.RigidVelocity((0.3, -0.2), 0.02)
    solution = bf.simulate(model, duration=1.0, step=1e-2, velocity=start)
    other = bf.simulate(bf.Model([beam(element)]), duration=1.0, step=1e-2, velocity=start)
    kinetic = solution.energy().kinetic
    assert kinetic[-1] == pytest.approx(other.energy().kinetic[-1], rel=1e-7)


@pytest.mark.parametrize("element", [bf.CRBF(order=3), bf.ANCF(), bf.ShearRigid()], ids=identify)
@pytest.mark.parametrize("framed", [False, True], ids=["chain", "frame"])
def test_a_small_vibration_decays_as_its_damping_ratio_says(element, framed):
    """Half a log decrement a half turn: exp(-z w t) with z = t w / 2, and the frequency w sqrt(1 - z^2)."""
    material = bf.Material(1e9, 0.3, 1000.0, retardation_time=0.0)
    section = bf.Rectangle(0.02, 0.02)

    def model(material):
        own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, section, material)
        others, joints = [], []
        if framed:  # a second beam that stands still makes the matrix sparse
            others = [bf.Beam(bf.Line((0, 0), (0, 0.1)), 1, element, section, material) for _ in range(2)]
            joints = [bf.Rigid(own.start, other.start) for other in others]
        supports = [bf.Clamp(own.start), *(bf.Clamp(other.end) for other in others)]
        return own, bf.Model([own, *others], supports, [bf.PointForce(own.end, (0, 1e-4))], joints)

    _, undamped = model(material)
    omega = 2 * np.pi * bf.solve_modes(undamped, count=1).frequencies[0]
    ratio = 0.05
    lossy = bf.Material(1e9, 0.3, 1000.0, retardation_time=2 * ratio / omega)
    bar, pulled = model(lossy)
    shape = bf.solve_modes(undamped, count=1)
    free = bf.Model(pulled.beams, pulled.supports, [], pulled.joints)
    state = bf.solve_static(pulled)
    period = 2 * np.pi / omega
    motion = bf.simulate(free, duration=6 * period, step=period / 400, start=state[-1])
    tip = motion.displacement(bar.end)[:, 1]
    peaks = np.flatnonzero((tip[1:-1] > tip[:-2]) & (tip[1:-1] >= tip[2:])) + 1
    late = peaks[1:]
    decay = np.log(tip[late[0]] / tip[late[-1]]) / (motion.time[late[-1]] - motion.time[late[0]])
    # peaks are found to one step of 400 a period, over four periods
    assert decay == pytest.approx(ratio * omega, rel=7e-4)
    assert np.diff(motion.time[late]).mean() == pytest.approx(period / np.sqrt(1 - ratio**2), rel=7e-4)
    assert len(shape.frequencies) == 1


def test_what_a_large_motion_loses_does_not_depend_on_how_it_is_integrated():
    """Steps of another method, and of half the length, lose the same energy."""
    own = damped(bf.CRBF(order=2), time=5e-3, end=(1.0, 0.0))
    model = bf.Model([own], [bf.Pin(own.start)], [bf.Gravity((0, -9.81))])
    found = []
    for step, integrator in ((1e-3, {}), (5e-4, {}), (2e-3, {"integrator": Radau()})):
        total = bf.simulate(model, duration=0.2, step=step, **integrator).energy().total
        found.append(total[0] - total[-1])
    assert found[0] > 1e-3
    assert found[1] == pytest.approx(found[0], rel=4e-4)  # of second order in the step
    assert found[2] == pytest.approx(found[1], rel=2e-4)


@pytest.mark.parametrize(("rho", "lag"), [(1.0, 0.002), (0.9, 0.52), (0.5, 0.55), (0.0, 0.8)])
@pytest.mark.parametrize("framed", [False, True], ids=["chain", "frame"])
def test_a_beam_creeps_under_a_sudden_load_and_back(rho, lag, framed):
    """1 - exp(-time / t) but for a lag, in steps, after the first; steps are far longer than a period of vibration.

    The acceleration of the first instant moved it to many times its static deflection, in silence.
    """
    material = bf.Material(7e6, 0.3, 1000.0, retardation_time=1e3)
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.02, 0.04), material)
    beams, joints, supports = [own], [], [bf.Clamp(own.start)]
    if framed:
        stands = [bf.Beam(bf.Line((0, 0), (0, 0.1)), 1, own.element, own.section, material) for _ in range(2)]
        beams, joints = [own, *stands], [bf.Rigid(own.start, stand.start) for stand in stands]
        supports += [bf.Clamp(stand.end) for stand in stands]
    loaded = bf.Model(beams, supports, [bf.PointForce(own.end, (0, -0.01))], joints)
    free = bf.Model(beams, supports, [], joints)
    static = bf.solve_static(loaded)
    last = static.displacement(own.end)[-1, 1]
    given = {"duration": 3e3, "step": 10.0, "integrator": bf.GeneralizedAlpha(rho)}
    onto, back = bf.simulate(loaded, **given), bf.simulate(free, start=static[-1], **given)
    crept = 1.0 - np.exp(-onto.time / 1e3)
    assert onto.displacement(own.end)[:, 1] / last == pytest.approx(crept, abs=lag * 10.0 / 1e3)
    assert back.displacement(own.end)[:, 1] / last == pytest.approx(1.0 - crept, abs=lag * 10.0 / 1e3)
    assert back.energy().total.max() <= back.energy().total[0] * (1.0 + 1e-9)


@mostly_slow("time", [1e-4, 5e-3, 0.1, 10.0], quick=(1,))
def test_stages_of_radau_know_the_damping(time):
    """Its tangents weigh p, p' and p'' each with zero somewhere."""
    material = bf.Material(7e6, 0.3, 1000.0, retardation_time=time)
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=2), bf.Rectangle(0.02, 0.04), material)
    model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0, -0.3))])
    stages = bf.simulate(model, duration=0.05, step=1e-3, integrator=Radau())
    fine = bf.simulate(model, duration=0.05, step=1e-4, integrator=bf.GeneralizedAlpha(1.0))
    expected = fine.displacement(own.end)[-1, 1]
    assert stages.displacement(own.end)[-1, 1] == pytest.approx(expected, rel=5e-5)


def test_section_forces_hold_the_damping():
    """Where mass is next to nothing, moment and load balance at any time; the angle creeps, t a' + a = M L / (E I)."""
    material = bf.Material(1e6, 0.3, 1e-3, retardation_time=0.1)
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=2), bf.Rectangle(0.1, 0.1), material)
    model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointMoment(own.end, 0.1, amplitude=lambda t: t / 0.3)])
    motion = bf.simulate(model, duration=0.3, step=1e-3)
    moment = motion.section_forces(own).moment[100:, 0]
    assert moment == pytest.approx(0.1 * motion.time[100:] / 0.3, rel=2e-5)
    last = 0.1 / (1e6 * 0.1**4 / 12)
    crept = last * (0.3 - 0.1 + 0.1 * np.exp(-0.3 / 0.1)) / 0.3
    assert motion.rotation(own.end)[-1] == pytest.approx(crept, rel=1e-3)


def test_a_law_of_a_section_is_damped_by_its_first_stiffness():
    given = {"axial": 1e6, "shear": 4e5, "bending": 100.0, "mass": 1.0, "rotary_inertia": 1e-4}
    section = RambergOsgood(**given, knee=20.0, exponent=3)
    models = []
    for time in (0.0, 1e-2):
        material = bf.Material(1e9, 0.3, 1.0, retardation_time=time)
        own = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(order=2), section, material)
        models.append(bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0, 30.0))]))
    static, same = (bf.solve_static(model) for model in models)
    assert np.array_equal(static.p, same.p)
    slow = bf.simulate(models[1], duration=4.0, step=5e-3)
    tip = slow.displacement(slow.model.beams[0].end)[-1]
    assert tip == pytest.approx(static.displacement(static.model.beams[0].end)[-1], rel=1e-4)


def test_statics_and_modes_know_no_damping():
    for element in (bf.CRBF(order=2), bf.ANCF()):
        own, plain = damped(element), beam(element)
        models = [bf.Model([one], [bf.Clamp(one.start)], [bf.PointForce(one.end, (0, 5.0))]) for one in (own, plain)]
        found, expected = (bf.solve_static(model) for model in models)
        assert np.array_equal(found.p, expected.p)
        frequencies = [bf.solve_modes(model, count=3).frequencies for model in models]
        assert np.array_equal(*frequencies)


def test_a_damped_motion_is_saved_and_goes_on(tmp_path):
    own = damped(bf.CRBF(order=2), end=(1.0, 0.0))
    model = bf.Model([own], [bf.Pin(own.start)], [bf.Gravity((0, -9.81))])
    first = bf.simulate(model, duration=0.1, step=1e-3)
    first.save(tmp_path / "a.h5")
    again = bf.load(tmp_path / "a.h5")
    assert again.model.beams[0].material.retardation_time == TIME
    assert np.array_equal(again.energy().total, first.energy().total)
    assert not first.warnings


@pytest.mark.parametrize(("time", "said"), [(-1.0, "must not be negative"), (np.nan, "be finite"), ("1", "number")])
def test_a_retardation_time_that_is_none_is_refused(time, said):
    with pytest.raises(bf.InputError, match=said):
        bf.Material(1e9, 0.3, 1e3, retardation_time=time)


def test_layers_with_different_retardation_times_are_refused():
    layers = [bf.Layer(bf.Material(1e9, 0.3, 1e3, retardation_time=time), 0.01) for time in (0.0, 1e-3)]
    with pytest.raises(bf.InputError, match=r"different retardation times \[0.0, 0.001\];"):
        bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(order=2), bf.Layered(layers, width=0.01))
