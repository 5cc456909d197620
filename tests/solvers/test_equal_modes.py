"""Modes of many equal and nearly equal parts: eigenvalues of high multiplicity are found whole, or in part if asked."""

from itertools import pairwise

import numpy as np
import pytest

import beamfem as bf

PARTS = 100


def cantilevers(number, *, longer=0.0, thickness=0.01, unit=1.0, stiffness=2e11, element=None):
    """Separate cantilevers of 1 m, each by `longer` times longer than the one before; unit: a metre in the model's."""
    material = bf.Material(stiffness / unit**2, 0.3, 7800.0)
    beams = [
        bf.Beam(
            bf.Line((0.0, 0.1 * i * unit), ((1.0 + longer * i) * unit, 0.1 * i * unit)),
            elements=2,
            element=element or bf.CRBF(3),
            section=bf.Circle(thickness * unit),
            material=material,
        )
        for i in range(number)
    ]
    return bf.Model(beams, [bf.Clamp(beam.start) for beam in beams])


@pytest.mark.parametrize("count", [1, 5, 10, 100, 101, 150])
def test_any_number_of_modes_of_a_hundred_equal_cantilevers_is_found(count):
    one = bf.solve_modes(cantilevers(1), 2).frequencies
    found = bf.solve_modes(cantilevers(PARTS), count)
    assert found.frequencies == pytest.approx(np.repeat(one, PARTS)[:count], rel=1e-11)
    assert np.linalg.matrix_rank(found.modes) == count


@pytest.mark.parametrize("longer", [1e-10, 1e-9, 1e-6, 1e-3])
def test_nearly_equal_cantilevers_have_the_modes_of_each(longer):
    lengths = 1.0 + longer * np.arange(PARTS)
    each = [
        bf.solve_modes(cantilevers(1, unit=length, stiffness=2e11 * length**2, thickness=0.01 / length), 2)
        for length in lengths
    ]
    exact = np.sort(np.concatenate([modes.frequencies for modes in each]))
    model = cantilevers(PARTS, longer=longer)
    for count in (1, 7, 150):
        assert bf.solve_modes(model, count).frequencies == pytest.approx(exact[:count], rel=1e-10)


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e-3])
@pytest.mark.parametrize("thickness", [1e-3, 1e-4])
def test_round_off_of_slender_cantilevers_does_not_hide_how_many_are_equal(thickness, unit):
    """It moves the eigenvalues of the plain tangent by more than the distance at which they are counted."""
    model = cantilevers(PARTS, thickness=thickness, unit=unit)
    one = bf.solve_modes(cantilevers(1, thickness=thickness, unit=unit), 2).frequencies
    for count in (1, 10, 150):
        assert bf.solve_modes(model, count).frequencies == pytest.approx(np.repeat(one, PARTS)[:count], rel=1e-9)


@pytest.mark.parametrize(
    "element", [bf.ANCF(), bf.ANCFCRBF(), bf.ShearRigid(), bf.BilinearANCF()], ids=lambda e: e.name
)
def test_equal_cantilevers_of_other_elements(element):
    one = bf.solve_modes(cantilevers(1, element=element), 2).frequencies
    for count in (1, 90):
        found = bf.solve_modes(cantilevers(60, element=element), count).frequencies
        assert found == pytest.approx(np.repeat(one, 60)[:count], rel=1e-10)


def test_a_row_of_equal_portals_sways_as_each_of_them():
    def portals(number):
        beams, supports, joints = [], [], []
        for x in 6.0 * np.arange(number):
            corners = [(x, 0.0), (x, 3.0), (x + 4.0, 3.0), (x + 4.0, 0.0)]
            left, top, right = (
                bf.Beam(bf.Line(a, b), 2, bf.CRBF(3), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
                for a, b in pairwise(corners)
            )
            beams += [left, top, right]
            supports += [bf.Clamp(left.start), bf.Clamp(right.end)]
            joints += [bf.Rigid(left.end, top.start), bf.Rigid(top.end, right.start)]
        return bf.Model(beams, supports, joints=joints)

    one = bf.solve_modes(portals(1), 4).frequencies
    for count in (1, 7, 60, 150):
        found = bf.solve_modes(portals(40), count).frequencies
        assert found == pytest.approx(np.repeat(one, 40)[:count], rel=1e-10)


def test_no_copy_of_a_mode_beside_a_follower_load_is_missed():
    """Seven equal columns and one under a small follower force: one of the seven was missed, without a word."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    force = -0.5 * section.rigidity(steel).bending

    def columns(loaded):
        beams = [bf.Beam(bf.Line((0, i), (1, i)), 40, bf.CRBF(3), section, steel) for i in range(len(loaded))]
        loads = [bf.PointForce(beams[i].end, (force, 0.0), follower=True) for i in np.flatnonzero(loaded)]
        model = bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], loads)
        return model, bf.solve_static(model) if loads else None

    plain, loaded = (bf.solve_modes(model, 3, about).frequencies for model, about in (columns([0]), columns([1])))
    model, about = columns([1] + 7 * [0])
    exact = np.sort(np.concatenate([loaded, np.repeat(plain, 7)]))
    for count in (2, 8, 12):
        assert bf.solve_modes(model, count, about).frequencies == pytest.approx(exact[:count], rel=1e-9)


@pytest.mark.slow
def test_a_hundred_equal_columns_buckle_at_the_same_load():
    """Linearised, some of them seemed to buckle at the second load of a column, nine times the first."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Circle(0.01)

    def columns(number):
        beams = [bf.Beam(bf.Line((0.1 * i, 0), (0.1 * i, 1)), 2, bf.CRBF(3), section, steel) for i in range(number)]
        force = (0.0, -section.rigidity(steel).bending)
        return bf.Model(beams, [bf.Clamp(b.start) for b in beams], [bf.PointForce(b.end, force) for b in beams])

    one = bf.solve_buckling(columns(1), 1)
    found = bf.solve_buckling(columns(PARTS), PARTS)
    assert found.load_factors == pytest.approx(np.repeat(one.load_factors, PARTS), rel=1e-9)
    assert found.linearised == pytest.approx(np.repeat(one.linearised, PARTS), rel=1e-8)
    assert np.linalg.matrix_rank(found.modes) == PARTS
