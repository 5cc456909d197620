"""Modes of slender, of stiff and of soft parts: no elastic one is taken for rigid, and none is missed."""

from contextlib import suppress
from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse.linalg import ArpackNoConvergence

import beamfem as bf
from beamfem.equations.system import Proven, System
from beamfem.linalg import eigenpairs

STEEL = bf.Material(2e11, 0.3, 7800.0)
CLAMPED_FREE = np.array([1.8751040687119611, 4.694091132974175, 7.854757438237613])
FREE_FREE = np.array([4.730040744862704, 7.853204624095838])


def euler(roots, section, material=STEEL, length=1.0):
    """Return the frequencies [Hz] of a thin beam with these roots of its frequency equation."""
    stiffness, mass = section.rigidity(material).bending, section.inertia(material).mass
    return roots**2 / (2 * np.pi * length**2) * np.sqrt(stiffness / mass)


def rod(thickness, element, elements, angle=0.0, material=STEEL):
    end = (np.cos(angle), np.sin(angle))
    return bf.Beam(bf.Line((0, 0), end), elements, element, bf.Circle(thickness), material)


def test_a_clamped_wire_of_a_tenth_of_a_millimetre_has_its_lowest_modes():
    """Rods of 1 m: 0.0708 Hz, which was taken for zero."""
    wire = rod(1e-4, bf.CRBF(3), 10)
    modes = bf.solve_modes(bf.Model([wire], [bf.Clamp(wire.start)]), 2)
    assert modes.rigid == ()
    assert modes.frequencies == pytest.approx(euler(CLAMPED_FREE[:2], wire.section), rel=2e-7)


@pytest.mark.parametrize("thickness", [1e-2, 1e-3, 1e-4, 3e-5, 1e-5])
@pytest.mark.parametrize("elements", [12, 60], ids=["dense", "sparse"])
def test_slender_rods_at_any_angle_have_the_modes_of_a_thin_beam(thickness, elements):
    """Shear and rotary inertia change a mode by less than 10 (d/L)^2; the rest is the field's order 8."""
    tolerance = 10 * thickness**2 + 2e-9
    for angle in (0.0, 0.7, 2.5):
        beam = rod(thickness, bf.CRBF(4), elements, angle)
        clamped = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 2)
        assert clamped.rigid == ()
        assert clamped.frequencies == pytest.approx(euler(CLAMPED_FREE[:2], beam.section), rel=tolerance + 1e-7)
        free = bf.solve_modes(bf.Model([beam]), 4)
        assert [words.split()[0] for words in free.rigid] == ["translates", "translates", "turns"]
        assert free.elastic == pytest.approx(euler(FREE_FREE[:1], beam.section), rel=tolerance + 1e-7)


@pytest.mark.parametrize("element", [bf.ANCF(), bf.ShearRigid(), bf.ANCFCRBF()], ids=lambda element: element.name)
def test_cubic_elements_keep_their_first_mode(element):
    """The frequencies of thin beams are proportional to the thickness, for whatever an element makes of E I."""
    first = []
    for thickness in (1e-3, 1e-3 / 3.0, 1e-5):
        beam = rod(thickness, element, 10)
        modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 1)
        assert modes.rigid == ()
        first.append(modes.frequencies[0] / thickness)
    assert first == pytest.approx(np.full(3, first[0]), rel=1e-3)


@pytest.mark.parametrize(("share", "growth"), [(1.001, np.pi**2 * np.sqrt(1e-3)), (1.1, np.pi**2 * np.sqrt(0.1))])
@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_a_hinged_column_just_above_its_critical_load_is_unstable(share, growth, angle):
    """E I = L = mass per length = 1, L/h = 1000: growth^2 = pi^4 (P/Pcr - 1)."""
    height = 1e-3
    section, material = bf.Rectangle(1.0, height), bf.Material(12.0 / height**3, 0.3, 1.0 / height)
    c, s = np.cos(angle), np.sin(angle)
    beam = bf.Beam(bf.Line((0, 0), (c, s)), 8, bf.CRBF(4), section, material)
    critical = bf.solve_buckling(_hinged(beam, (-c, -s))).load_factors[0]
    model = _hinged(beam, (-share * critical * c, -share * critical * s))
    straight = bf.Model([beam], [bf.Clamp(beam.start), bf.Roller(beam.end, (-s, c))], model.loads)
    modes = bf.solve_modes(model, 2, about=bf.solve_static(straight))
    assert critical == pytest.approx(np.pi**2, rel=3e-6)
    assert modes.growth[0] == pytest.approx(growth, rel=1e-5)
    assert modes.growth[1] == 0.0
    assert modes.rigid == ()


def _hinged(beam, force):
    along = np.array(beam.end.reference)
    return bf.Model(
        [beam],
        [bf.Pin(beam.start), bf.Roller(beam.end, (-along[1], along[0]))],
        [bf.PointForce(beam.end, force)],
    )


def test_a_soft_beam_on_a_stub_a_billion_times_as_stiff():
    soft, hard = bf.Material(1e3, 0.3, 1000.0), bf.Material(1e12, 0.3, 1000.0)
    section = bf.Rectangle(0.01, 0.01)
    stub = bf.Beam(bf.Line((-0.2, 0), (0, 0)), 4, bf.CRBF(4), section, hard)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, soft)
    both = bf.Model([stub, beam], [bf.Clamp(stub.start)], joints=[bf.Rigid(stub.end, beam.start)])
    alone = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 4).frequencies
    assert bf.solve_modes(both, 4).frequencies == pytest.approx(alone, rel=1e-7)
    assert alone[0] == pytest.approx(euler(CLAMPED_FREE, section, soft)[0], rel=1e-4)


def test_springs_of_every_kind_are_in_the_modes():
    """A stiff bar on springs: bounce sqrt(k/m), and about its pin sqrt(kt/J); 0 Hz without them."""
    stiff, section = bf.Material(1e16, 0.3, 7800.0), bf.Rectangle(0.05, 0.05)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), section, stiff)
    mass = 7800.0 * section.area
    inertia = mass / 3.0 + 7800.0 * section.second_moment
    for place in (0.5, 0.4):
        held = [bf.Spring(beam.at(place), (3e5, 2e5), 1e7)]
        modes = bf.solve_modes(bf.Model([beam], held), 3)
        assert modes.rigid == ()
        along = 2 * np.pi * modes.frequencies
        assert np.abs(along / np.sqrt(3e5 / mass) - 1.0).min() < 1e-4
    turning = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start), bf.Spring(beam.start, rotational=4e5)]), 1)
    assert 2 * np.pi * turning.frequencies == pytest.approx(np.sqrt(4e5 / inertia), rel=1e-4)
    tip = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start), bf.Spring(beam.end, (0.0, 1e5))]), 1)
    assert 2 * np.pi * tip.frequencies == pytest.approx(np.sqrt(1e5 / inertia), rel=1e-4)
    tiny = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start), bf.Spring(beam.end, (0.0, 1e-9))]), 1)
    assert tiny.rigid == ()
    assert 2 * np.pi * tiny.frequencies == pytest.approx(np.sqrt(1e-9 / inertia), rel=1e-3)


def test_a_mode_that_the_iteration_misses_is_found_again(monkeypatch):
    beam = rod(0.05, bf.CRBF(2), 60)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    exact = bf.solve_modes(model, 5).frequencies
    whole, calls = eigenpairs.eigsh, []

    def forgetful(*args, **options):
        values, shapes = whole(*args, **options)
        calls.append(len(values))
        if len(calls) > 1:
            return values, shapes
        kept = np.argsort(values) != 1
        return values[kept], shapes[:, kept]

    monkeypatch.setattr(eigenpairs, "eigsh", forgetful)
    assert bf.solve_modes(model, 5).frequencies == pytest.approx(exact, rel=1e-9)
    assert len(calls) > 1


def test_modes_are_found_where_the_iteration_does_not_converge(monkeypatch):
    beam = rod(0.05, bf.CRBF(2), 60)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    exact = bf.solve_modes(model, 5).frequencies

    def never(*args, **options):
        raise ArpackNoConvergence("no convergence", np.empty(0), np.empty((0, 0)))

    monkeypatch.setattr(eigenpairs, "eigsh", never)
    assert bf.solve_modes(model, 5).frequencies == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("elements", [10, 60], ids=["dense", "sparse"])
@pytest.mark.parametrize("apart", [1e-3, 1e-6, 1e-9, 0.0])
def test_nearly_equal_modes_are_told_apart(elements, apart):
    """Two independent rods of moduli E and E (1 + apart)."""
    beams = [
        bf.Beam(bf.Line((0, i), (1, i)), elements, bf.CRBF(3), bf.Circle(0.01), bf.Material(modulus, 0.3, 7800.0))
        for i, modulus in enumerate((2e11, 2e11 * (1.0 + apart)))
    ]
    one = bf.solve_modes(bf.Model(beams[:1], [bf.Clamp(beams[0].start)]), 2).frequencies
    modes = bf.solve_modes(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams]), 4)
    exact = np.outer(one, [1.0, np.sqrt(1.0 + apart)]).ravel()
    assert modes.frequencies == pytest.approx(exact, rel=1e-11)


def test_hinged_bars_are_rigid_until_something_pulls_them():
    """Two bars hinged in line: a mechanism of first order at 0 Hz, a swing under tension T: omega^2 = 3 T/(m L^2)."""
    stiff, section = bf.Material(1e12, 0.3, 7800.0), bf.Rectangle(0.02, 0.02)
    left = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), section, stiff)
    right = bf.Beam(bf.Line((1, 0), (2, 0)), 4, bf.CRBF(3), section, stiff)
    supports = [bf.Pin(left.start), bf.Roller(right.end)]
    loose = bf.Model([left, right], supports, joints=[bf.Hinge(left.end, right.start)])
    assert len(bf.solve_modes(loose, 1).rigid) == 1
    held = bf.Model([left, right], [*supports, bf.Roller(left.end)], joints=loose.joints)
    pulled = bf.Model([left, right], supports, [bf.PointForce(right.end, (100.0, 0.0))], loose.joints)
    tight = bf.Model(held.beams, held.supports, pulled.loads, held.joints)
    modes = bf.solve_modes(pulled, 1, about=bf.solve_static(tight))
    assert modes.rigid == ()
    mass, length = 7800.0 * section.area, 1.0
    inertia = 2.0 * (mass * length / 3.0 + 7800.0 * section.second_moment / length)
    assert 2 * np.pi * modes.frequencies == pytest.approx(np.sqrt(2.0 * 100.0 / length / inertia), rel=1e-4)


@pytest.mark.parametrize(("angle", "mirror", "unit"), [(0.3, 1.0, 1.0), (2.0, -1.0, 1.0), (0.0, 1.0, 1e3)])
def test_a_portal_has_the_same_modes_turned_mirrored_and_in_millimetres(angle, mirror, unit):
    reference = bf.solve_modes(_portal(0.0, 1.0, 1.0), 6).frequencies
    assert bf.solve_modes(_portal(angle, mirror, unit), 6).frequencies == pytest.approx(reference, rel=1e-9)


def _portal(angle, mirror, unit):
    c, s = np.cos(angle), np.sin(angle)
    place = unit * np.array([[c, -s], [s, c]]) @ np.diag([mirror, 1.0])
    corners = [tuple(place @ corner) for corner in ((0.0, 0.0), (0.1, 1.0), (1.3, 0.9), (1.2, 0.0))]
    material = bf.Material(2e11 / unit**2, 0.3, 7800.0 / unit**4)
    section = bf.Rectangle(0.02 * unit, 0.001 * unit)
    bars = [bf.Beam(bf.Line(a, b), 5, bf.CRBF(3), section, material) for a, b in pairwise(corners)]
    joints = [bf.Rigid(bars[0].end, bars[1].start), bf.Hinge(bars[1].end, bars[2].start)]
    return bf.Model(bars, [bf.Clamp(bars[0].start), bf.Pin(bars[2].end)], joints=joints)


@pytest.mark.parametrize("ratio", [1e2, 1e5, 1e8])
def test_a_stiff_bar_hinged_to_a_soft_wire_hides_none_of_its_modes(ratio):
    """The swing of the wire with the bar at its end was lost beside a bar 3e5 times as stiff."""
    frequencies = []
    for stiffness in (2e10, 2e10 * ratio):
        parts = [
            bf.Beam(bf.Line(*ends), 7, bf.ANCFCRBF(bf.ElasticLine()), bf.Circle(1e-4), bf.Material(youngs, 0.3, 1000.0))
            for ends, youngs in ((((0, 0), (1, 0)), 2e5), (((1, 0), (1.8, 0.6)), stiffness))
        ]
        joint = bf.Hinge(parts[0].end, parts[1].start)
        modes = bf.solve_modes(bf.Model(parts, [bf.Clamp(parts[0].start)], joints=[joint]), 5)
        assert len(modes.rigid) == 1
        frequencies.append(modes.frequencies[1:])
    # a bar 1e5 times as stiff as the wire bends as much less
    assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-4)


@pytest.mark.parametrize("with_stresses", [False, True])
@pytest.mark.parametrize("slenderness", [1e3, 1e5])
@pytest.mark.parametrize("pinned", [False, True])
def test_a_body_that_was_turned_vibrates_as_in_its_reference(pinned, slenderness, with_stresses, monkeypatch):
    """It moves freely, so that no correction balances the last digits of its state, by either kind of tangent."""
    section = bf.Rectangle(1.0, 1.0 / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), section, bf.Material(1e9, 0.0, 1000.0))
    led = bf.Model([beam], [bf.Prescribed(beam.start, ux=0.0, uy=0.0, rotation=1.0)])
    model = bf.Model([beam], [bf.Pin(beam.start)] if pinned else [])
    expected = bf.solve_modes(model, 6).frequencies
    if with_stresses:
        monkeypatch.setattr(System, "forget_digits", lambda system: system.proven.add(Proven.LOSES_DIGITS))
    found = bf.solve_modes(model, 6, about=bf.solve_static(led, steps=5)).frequencies
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * expected[-1])
    assert list(found[:3] == 0.0) == [True, not pinned, not pinned]


@pytest.mark.parametrize("before", [bf.solve_modes, bf.solve_static], ids=["modes", "static"])
def test_modes_do_not_depend_on_earlier_solves(before):
    """A foil that carries a block: after a solve that had lost digits, frequencies were up to 2.5 times as high."""
    thickness, steel = 1.77e-7, bf.Material(2.1e11, 0.3, 7850.0)
    foil = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.01, thickness), steel)
    block = bf.Beam(bf.Line((1, 0), (1, 1)), 4, bf.ANCF(), bf.Rectangle(0.1, 0.1), steel)
    bending = 2.1e11 * 0.01 * thickness**3 / 12.0
    load = bf.PointForce(foil.end, (0.0, 3.36 * bending))
    model = bf.Model([foil, block], [bf.Clamp(foil.start)], [load], [bf.Rigid(foil.end, block.start)])
    with suppress(bf.ConvergenceError):
        before(model)
    # a massless foil with the mass and inertia of the block about its end
    inertia = np.diag([78.5, 78.5 * (1.0 + 0.1**2) / 3.0])
    stiffness = bending * np.array([[12.0, -6.0], [-6.0, 4.0]])
    exact = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real)) / (2.0 * np.pi)
    assert bf.solve_modes(model, 2).frequencies == pytest.approx(exact, rel=5e-3)
