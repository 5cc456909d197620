"""Modes with damping, and effective masses, against closed forms, dense eigenvalues and decaying motions."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.linalg import eigenpairs

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
SQUARE = bf.Rectangle(0.02, 0.02)
LIGHT = bf.Material(2.1e11, 0.3, 1e-6)


def beam_of(start, end, elements=4, material=STEEL):
    return bf.Beam(bf.Line(start, end), elements, bf.CRBF(3), SQUARE, material)


def oscillator(stiffness, damping, mass=1.0):
    """Return a mass on a spring and a damper: one on a light bar that slides along x."""
    bar = beam_of((0, 0), (0.1, 0), 1, LIGHT)
    return bf.Model(
        [bar],
        [bf.Roller(bar.start, normal=(0, 1)), bf.Roller(bar.end, normal=(0, 1))],
        connectors=[bf.SpringDamper(bar.start, (-1.0, 0.0), stiffness, damping)],
        masses=[bf.PointMass(bar.start, mass)],
    )


def test_a_mass_with_spring_and_damper_has_the_rate_of_the_closed_form():
    stiffness, damping = 50.0, 3.0
    modes = bf.linearise(oscillator(stiffness, damping)).modes(1)
    rate, decay = np.sqrt(stiffness), damping / 2.0
    assert 2.0 * np.pi * modes.frequencies[0] == pytest.approx(np.sqrt(rate**2 - decay**2), rel=1e-6)
    assert modes.growth[0] == pytest.approx(-decay, rel=1e-6)
    assert modes.ratios[0] == pytest.approx(decay / rate, rel=1e-6)


def test_an_overdamped_mass_has_two_rates_without_vibration():
    modes = bf.linearise(oscillator(50.0, 30.0)).modes(2)
    assert np.all(modes.frequencies == 0.0)
    assert sorted(modes.growth) == pytest.approx(sorted(np.roots([1.0, 30.0, 50.0])), rel=1e-6)
    assert np.all(modes.ratios == 1.0)
    assert len(modes.solution(0)) == 25


def test_a_mass_with_a_damper_alone_moves_rigidly_or_decays():
    modes = bf.linearise(oscillator(0.0, 30.0)).modes(2)
    assert modes.rigid == ("translates along x",)
    assert modes.growth == pytest.approx([0.0, -30.0], rel=1e-6)
    assert modes.ratios.tolist() == [0.0, 1.0]


@pytest.mark.parametrize("elements", [4, 40], ids=["dense", "sparse"])
def test_without_damping_modes_are_those_of_solve_modes(elements):
    beam = beam_of((0, 0), (1, 0.3), elements)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-100.0, -300.0))])
    bent = bf.solve_static(model)
    damped, modes = bf.linearise(model, bent).modes(6), bf.solve_modes(model, 6, bent)
    assert damped.frequencies == pytest.approx(modes.frequencies, rel=1e-8)
    assert np.all(damped.growth == 0.0)
    assert damped.modes == pytest.approx(modes.modes, abs=1e-6 * np.abs(modes.modes).max())


def test_rigid_modes_are_those_of_solve_modes():
    model = bf.Model([beam_of((0, 0), (1, 0.3))])
    damped, modes = bf.linearise(model).modes(5), bf.solve_modes(model, 5)
    assert damped.rigid == modes.rigid
    assert np.all(damped.frequencies[:3] == 0.0)
    assert damped.frequencies[3:] == pytest.approx(modes.frequencies[3:], rel=1e-8)
    assert damped.modes[:3] == pytest.approx(modes.modes[:3], abs=1e-8)


def test_all_rates_are_the_eigenvalues_of_the_first_order_form():
    """A frame with dampers, one along a link: as many as there are, whatever they are."""
    left, right = beam_of((0, 0), (0, 1), 2), beam_of((1, 0), (1, 1.2), 2)
    parts = [bf.Link(left.end, right.end), bf.SpringDamper(left.at(0.5), right.end, 1e4, 300.0)]
    parts.append(bf.TorsionSpring(left.end, right.end, 10.0, 3.0))
    model = bf.Model([left, right], [bf.Clamp(left.start), bf.Pin(right.start)], connectors=parts)
    linear = bf.linearise(model)
    modes = linear.modes(len(linear))
    rates = np.linalg.eigvals(linear.state_space()[0])
    rates = rates[rates.imag >= -1e-6 * np.abs(rates)]
    rates = rates[np.argsort(np.abs(rates))][: len(modes)]
    found = modes.growth + 2j * np.pi * modes.frequencies
    assert np.sort(np.abs(found)) == pytest.approx(np.abs(rates), rel=1e-6)
    assert np.sort(modes.growth) == pytest.approx(np.sort(rates.real), rel=1e-4, abs=1e-7 * np.abs(rates).max())


def test_equal_damped_cantilevers_have_every_mode_as_often_as_there_are_beams(monkeypatch):
    monkeypatch.setattr(eigenpairs, "_DENSE", 10)
    beams = [beam_of((0, y), (1, y), 2) for y in range(6)]
    dampers = [bf.SpringDamper(beam.end, (1.0, y + 0.5), 0.0, 10.0) for y, beam in enumerate(beams)]
    model = bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], connectors=dampers)
    modes = bf.linearise(model).modes(12)
    alone = bf.linearise(bf.Model(beams[:1], [bf.Clamp(beams[0].start)], connectors=dampers[:1])).modes(2)
    assert modes.frequencies == pytest.approx(np.repeat(alone.frequencies, 6), rel=1e-7)
    assert modes.ratios == pytest.approx(np.repeat(alone.ratios, 6), rel=1e-6)


def test_a_motion_decays_as_its_mode(tmp_path):
    beam = beam_of((0, 0), (1, 0))
    damper = bf.SpringDamper(beam.end, (1.0, 1.0), 0.0, 5.0)
    model = bf.Model([beam], [bf.Clamp(beam.start)], connectors=[damper])
    modes = bf.linearise(model).modes(2)
    assert np.iscomplexobj(modes.modes)
    start = modes.solution(0, amplitude=1e-5)
    motion = bf.simulate(model, duration=start.at[-1], step=start.at[-1] / 1000, start=start[0])
    assert motion.displacement(beam.end)[-1, 1] == pytest.approx(start.displacement(beam.end)[-1, 1], rel=2e-4)
    first = modes.plot(tmp_path / "modes.png").axes[0]
    assert first.get_title() == f"1: {modes.frequencies[0]:.4g} Hz, damping ratio {modes.ratios[0]:.3g}"


def test_a_viscous_material_damps_each_mode_in_proportion_to_its_frequency():
    beam = beam_of((0, 0), (1, 0), 4, bf.Material(2.1e11, 0.3, 7850.0, retardation_time=1e-5))
    modes = bf.linearise(bf.Model([beam], [bf.Clamp(beam.start)])).modes(4)
    size = np.hypot(modes.growth, 2.0 * np.pi * modes.frequencies)
    assert modes.ratios == pytest.approx(0.5 * 1e-5 * size, rel=1e-8)


def test_a_column_beyond_its_critical_load_diverges():
    beam = beam_of((0, 0), (1, 0))
    critical = np.pi**2 * SQUARE.rigidity(STEEL).bending / 4.0
    loads = [bf.PointForce(beam.end, (-1.1 * critical, 0.0))]
    model = bf.Model([beam], [bf.Clamp(beam.start)], loads)
    straight = bf.solve_static(model.with_(supports=[*model.supports, bf.Roller(beam.end, normal=(0, 1))]))
    modes = bf.linearise(model, straight).modes(2)
    expected = bf.solve_modes(model, 1, straight)
    assert modes.growth[0] == pytest.approx(expected.growth[0], rel=1e-6)
    assert modes.status is bf.Status.UNSTABLE


def test_effective_masses_of_a_free_body_are_its_mass_and_inertia():
    beam = beam_of((0, 0), (1, 0.5))
    model = bf.Model([beam], masses=[bf.PointMass(beam.end, 2.0)])
    modes = bf.solve_modes(model, 39)
    for direction in ((1.0, 0.0), (0.0, -3.0), (1.0, 2.0)):
        assert modes.effective_masses(direction).sum() == pytest.approx(model.mass, rel=1e-9)
        assert modes.effective_masses(direction)[:2].sum() == pytest.approx(model.mass, rel=1e-9)
    length = np.hypot(1.0, 0.5)
    inertia = SQUARE.area * 7850.0 * length**3 / 3.0 + SQUARE.inertia(STEEL).rotary * length + 2.0 * length**2
    assert modes.effective_masses(bf.RigidVelocity(angular=1.0)).sum() == pytest.approx(inertia, rel=1e-6)


def test_effective_masses_of_a_cantilever_are_those_of_the_beam_theory():
    """Bernoulli: 0.6131, 0.1883, 0.0647 and 0.0331 of the mass (Blevins); all together converge to the mass."""
    slender = [bf.Beam(bf.Line((0, 0), (1, 0)), n, bf.CRBF(3), bf.Rectangle(0.01, 0.01), STEEL) for n in (2, 4, 8)]
    missing = []
    for beam in slender:
        model = bf.Model([beam], [bf.Clamp(beam.start)])
        modes = bf.solve_modes(model, 9 * beam.elements)
        missing.append(1.0 - modes.effective_masses((0, 1)).sum() / model.mass)
    fractions = modes.effective_masses((0, 1))[:4] / model.mass
    assert fractions == pytest.approx([0.6131, 0.1883, 0.0647, 0.0331], abs=1e-4)
    assert np.array(missing[:-1]) / missing[1:] == pytest.approx([2.0, 2.0], rel=0.05)
    assert np.all(modes.participation((0, 1)) ** 2 == modes.effective_masses((0, 1)))
    assert np.allclose(modes.participation((0, -1)), -modes.participation((0, 1)))


def portal(connector, masses=()):
    left, right = beam_of((0, 0), (0, 1)), beam_of((1, 0), (1, 1))
    feet = [bf.Clamp(left.start), bf.Clamp(right.start)]
    tied = [connector(left.end, right.end)]
    return bf.Model([left, right], feet, [bf.PointForce(left.end, (1, 0))], connectors=tied, masses=masses)


@pytest.mark.parametrize("stiffness", [1e12, 1e16, 1e18, 1e20, 1e22, 1e25, 1e30, 1e40])
def test_a_very_stiff_spring_is_a_link_or_is_named(stiffness):
    """Round-off of its assembled stiffness hides that of the columns: up to 3 wrong digits, or an error."""
    stiff, link = portal(lambda a, b: bf.SpringDamper(a, b, stiffness)), portal(bf.Link)
    for found in (
        lambda model: bf.linearise(model).modes(3).frequencies,
        lambda model: bf.solve_modes(model, 3).frequencies,
        lambda model: abs(bf.frequency_response(model, model.loads[0], ("ux", model.beams[1].end), [3.0]).values),
    ):
        try:
            values = found(stiff)
        except (bf.ConvergenceError, bf.InputError) as error:
            refused = str(error)
        else:
            assert values == pytest.approx(found(link), rel=2e-3)
            continue
        assert "SpringDamper at (0, 1) and (1, 1)" in refused or "orders of magnitude" in refused or "hidden" in refused
        assert stiffness > 1e14


@pytest.mark.parametrize("inertia", [1.0, 1e3, 1e6, 1e10, 1e20, 1e50, 1e100])
def test_a_very_large_inertia_leaves_the_other_modes_or_is_named(inertia):
    """The stiffness is that of the columns: the body turns slowly, all else vibrates as if its rotation were fixed."""
    bare = portal(lambda a, b: bf.SpringDamper(a, b, 1e5))
    heavy = bare.with_(masses=[bf.RigidBody(bare.beams[0].end, 1.0, inertia, (0.0, 0.0))])
    if inertia > 1e6:
        with pytest.raises(bf.ConvergenceError, match="orders of magnitude"):
            bf.linearise(heavy).modes(4)
    else:
        assert bf.linearise(heavy).modes(4).frequencies == pytest.approx(bf.solve_modes(heavy, 4).frequencies, rel=1e-6)


def test_a_very_slender_beam_is_not_taken_for_a_mechanism():
    """Its bending is within the round-off of its axial stiffness, but supports hold it."""
    wire = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(8), bf.Rectangle(1e-5, 1e-5), STEEL)
    with pytest.raises(bf.ConvergenceError, match="no three digits"):
        bf.linearise(bf.Model([wire], [bf.Clamp(wire.start)])).modes(2)


def test_a_light_bar_beside_a_mass_has_its_own_modes():
    """Rates of 3 and 2e9 rad/s: shapes of the fast ones have no part of the slow one, whose mass is far larger."""
    linear = bf.linearise(oscillator(10.0, 1.0))
    modes = linear.modes(4)
    z = modes.modes[:, linear.coordinates]
    assert modes.growth[0] == pytest.approx(-0.5, rel=1e-6)
    assert np.abs(np.triu(z.conj() @ (linear.mass @ z.T), 1)).max() < 1e-6
    without = bf.solve_modes(oscillator(10.0, 1.0).with_(connectors=[]), 4).elastic
    assert modes.frequencies[1:] == pytest.approx(without, rel=1e-6)


def damped_at_its_end():
    beam = beam_of((0, 0), (1, 0))
    return bf.linearise(
        bf.Model([beam], [bf.Clamp(beam.start)], connectors=[bf.SpringDamper(beam.end, (1.0, 1.0), 0.0, 50.0)])
    )


def test_bad_input_is_named():
    model = oscillator(10.0, 1.0)
    with pytest.raises(bf.InputError, match="only 10 modes"):
        bf.linearise(model).modes(100)
    with pytest.raises(bf.InputError, match="those of undamped modes"):
        damped_at_its_end().modes(2).effective_masses((1, 0))
    with pytest.raises(bf.InputError, match="must not be"):
        bf.solve_modes(model.with_(connectors=[]), 1).participation((0, 0))
