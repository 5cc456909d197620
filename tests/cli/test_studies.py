"""Every study runs small, and its headline numbers are those of closed forms and of references without elements."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

import beamfem as bf
from beamfem.element.coordinates import Gradients, Rotation
from beamfem.element.fields import Lagrange
from studies.paper import cantilever_small, curved, elastica, elements, locking, rollup
from studies.stability import page as stability

STEEL = bf.Material(2e11, 0.3, 7800.0)


@pytest.mark.parametrize(
    ("slenderness", "load", "tip"),
    [
        (10, 5.0, (-0.38922722797924, 0.72054526137677)),
        (100, 5.0, (-0.38764432832607, 0.71385896416489)),
        (100, 0.06, (-0.00023985674764, 0.01999333673484)),
        (None, 1.0, (-0.05643323628337688, 0.3017207737998135)),
        (None, 5.0, (-0.3876283607244299, 0.7137915236119127)),
    ],
)
def test_shooting_finds_the_references(slenderness, load, tip):
    """Family 1: elliptic integrals (elastica), collocation (Reissner, k_s = 5/6), 12 digits."""
    if slenderness is None:
        found = elastica.tip_displacement(1.0, (0.0, load), 1.0)
    else:
        axial = 12.0 * slenderness**2  # of E I = 1
        found = elastica.tip_displacement(1.0, (0.0, load), 1.0, axial, 5.0 / 6.0 * axial / 2.6)
    assert found == pytest.approx(tip, abs=2e-12)


def test_shooting_of_a_curved_beam_is_castigliano_for_a_small_load():
    """A quarter ring clamped along x, force H across the clamp at its end: M = H R (1 - sin), u_y its square's sum."""
    _, v = elastica.tip_displacement(np.pi / 2, (0.0, 1e-5), 1.0, curvature=1.0)
    assert v / 1e-5 == pytest.approx(3 * np.pi / 4 - 2, rel=1e-4)


def test_cantilever_of_section_3_4(tmp_path):
    """P L^3 / (3 E I) = 2.0000e-2 m, printed as 1.9908e-2; elastic line to the extensible elastica, with order 4."""
    assert cantilever_small.linear() == pytest.approx(2.0e-2, rel=1e-12)
    # the inextensible elastica's series v/L = a/3 - 4 a^3/105 with a = P L^2 / (E I), and shortening changes 1e-8 of it
    assert cantilever_small.LIMITS[cantilever_small.LINE] == pytest.approx(0.02 - 4 * 0.06**3 / 105, abs=3e-8)
    values = cantilever_small.main(meshes=(12, 48, 96))
    for (name, kind), found in values.items():
        errors = np.abs(np.array(found) / cantilever_small.LIMITS[kind] - 1.0)
        if name == "bilinear-CRBF":
            assert errors[0] > 0.9, "full integration locks in shear"
        elif kind == cantilever_small.LINE:
            assert errors[0] < 2e-3
            assert 3.2 < np.log2(errors[1] / errors[2]) < 4.1, "shear locking of the line dies out with order 4"
        else:
            assert 1.9 < np.log2(errors[1] / errors[2]) < 2.1
    page = cantilever_small.part(tmp_path, (6, 12, 24))
    assert "1.9908e-02" in page.entries[0].claim
    assert "2.0000e-02" in page.entries[0].found
    assert (tmp_path / "convergence.svg").stat().st_size > 0


def test_limits_of_continuum_forces_are_those_of_collocation(monkeypatch):
    """Cases 11.ii, P = 10 N: stationary energy of the continuum, degree 10 on 9 graded pieces."""
    monkeypatch.setattr(elements, "LOAD", 0.06)
    for plane_stress, tip in (
        (False, (-0.0001324099067977, 0.01485507106598)),
        (True, (-0.0001986563066799, 0.01819510330389)),
    ):
        element = bf.Element(Lagrange(8), Gradients(), bf.ContinuumMechanics(plane_stress))
        found, source = elements.limit.__wrapped__(element, 100)
        assert source == elements.FINE
        assert found == pytest.approx(tip, abs=1e-10)


@pytest.mark.parametrize(
    ("element", "orders", "errors"),
    [
        (bf.CRBF(1), (1.95, 2.05), (1e-3, 1e-3)),
        (bf.CRBF(2), (3.8, 4.1), (2e-5, 2e-5)),
        (bf.CRBF(3), (5.7, 6.1), (5e-7, 5e-7)),
        (bf.CRBF(4), (7.1, 8.2), (2e-8, 2e-8)),
        (bf.CRBF(8), (12.0, 16.5), (1e-12, 1e-12)),
        (bf.ANCFCRBF(bf.Structural()), (1.9, 2.1), (3e-4, 3e-4)),
        (bf.ANCF(bf.Structural()), (1.9, 2.1), (3e-4, 3e-4)),
        (bf.ANCF(bf.Structural(), "full"), (1.9, 2.5), (3e-4, 3e-3)),
        (bf.ANCF(), (1.9, 2.5), (3e-4, 2e-3)),
        (bf.ShearRigid(True), (1.9, 2.1), (3e-4, 3e-4)),
        (bf.ShearRigid(False), (1.9, 2.1), (3e-4, 3e-4)),
        # the limit is Reissner's beam with 1.2 times the shear stiffness, and with the fixed |r_x| 1.2 times E A
        (bf.ShearRigid(True, integration="full"), (1.9, 2.1), (3e-4, 3e-4)),
        (bf.ShearRigid(False, integration="full"), (1.9, 2.1), (3e-4, 3e-4)),
    ],
    ids=lambda value: f"{value.name}-{value.integration}" if isinstance(value, bf.Element) else "",
)
def test_elements_converge_to_their_limits(element, orders, errors):
    for found, error in zip(elements.main([element], repeats=0), errors, strict=True):
        assert found.error < error
        assert orders[0] < found.order < orders[1]


def test_the_elastic_line_has_order_four():
    (found,) = elements.main([bf.ANCFCRBF(bf.ElasticLine())], slenderness=(10,), repeats=0)
    assert found.error < 5e-6
    assert 3.8 < found.order < 4.4


def test_the_table_holds_every_combination_once():
    every = list(elements.combinations())
    assert len(set(every)) == len(every) == 130
    table = elements.table(elements.main(every[:1], repeats=1))
    assert len(table.rows) == 1
    assert len(table.rows[0]) == len(table.header)


def test_locking_factors_are_those_of_closed_forms():
    found = locking.main(ratios=(0.0, 0.3, 0.49), slenderness=(10, 100, 1000), meshes=(1, 4))
    for forces, factors in found.bending.items():
        for ratio, factor in zip(found.ratios, factors, strict=True):
            assert factor == pytest.approx(locking.expected_factor(forces, ratio), rel=1e-9)
    assert found.bending["continuum, 3D"][1] == pytest.approx(1.346153846, abs=1e-9)
    assert found.bending["continuum, plane stress"][1] == pytest.approx(1.098901099, abs=1e-9)
    for slenderness, ratio in zip(found.slenderness, found.deflection["bilinear, full"], strict=True):
        assert ratio == pytest.approx(locking.locked(12, slenderness), rel=2e-5)
    # a curvature that is constant in each of 12 elements bends 1 - 1 / (4 n^2), at any thickness
    assert found.deflection["bilinear, 1 point"][1:] == pytest.approx([1 - 1 / 576] * 2, rel=1e-4)
    assert found.deflection["order 2, 2 points"] == pytest.approx([1.0] * 3, rel=2e-6)


def test_nodes_without_shear_are_stiffer_by_six_fifths_in_full_integration_only():
    found = locking.main(ratios=(0.3,), slenderness=(10,), meshes=(1, 4))
    for (name, integration), factors in found.shear.items():
        stiffer = 1.2 if integration == "full" else 1.0
        assert factors == pytest.approx([stiffer] * 2, rel=1e-7)
        stretched = stiffer if name == "shear-rigid" else 1.0
        assert found.stretch[name, integration] == pytest.approx([stretched] * 2, rel=1e-9)


@pytest.mark.parametrize(("integration", "mean"), [("reduced", 1.0), ("full", 1.0 / 1.2)])
def test_stress_on_the_axis_vanishes_at_nodes_without_stretch_and_not_in_the_mean(integration, mean):
    found = locking.stresses(integration=integration)
    assert found.at_nodes < 1e-9 * found.exact_axis
    assert found.mean == pytest.approx(mean * found.exact_axis, rel=2e-5)
    # bending moment at the middle of the first of four elements, constant in it: 7/8 of that at the clamp
    bending = found.exact_axis - found.exact_face[0]
    assert found.face[0] == pytest.approx(-7.0 / 8.0 * bending, rel=1e-2)


@pytest.mark.slow
def test_locking_is_drawn(tmp_path):
    part = locking.part(tmp_path)
    assert [entry.picture.stat().st_size > 0 for entry in part.entries] == [True] * 3
    assert "the mean over the beam is not zero".lower() in part.entries[2].found.lower()


@pytest.mark.parametrize("thinness", [10, 1000])
def test_a_half_ring_bends_as_castigliano_says(thinness):
    """What is quadratic in the load of 1e-5 is taken out; its square is left, with a factor of about 6."""
    assert curved.castigliano(bf.CRBF(8), 3, thinness) == pytest.approx([1.0, 1.0], abs=1e-9)
    assert curved.castigliano(bf.CRBF(4), 6, thinness) == pytest.approx([1.0, 1.0], abs=2e-7)


def test_gradients_do_not_lock_on_a_thin_ring():
    """With the thickness strain at the Gauss points 24 ANCF elements kept a twentieth of the deflection."""
    gradients, rotations = (curved.castigliano(make(bf.Structural()), 24, 1000) for make in (bf.ANCF, bf.ANCFCRBF))
    assert gradients == pytest.approx(rotations, abs=1e-7)
    assert np.all(gradients > 0.94)


def test_continuum_forces_lock_on_a_thin_ring():
    """Stated on the page: eyy of the whole body feels that an interpolated d is shorter between nodes."""
    assert np.all(curved.castigliano(bf.ANCF(), 24, 1000) < 0.1)


def test_order_eight_is_the_shooting_of_a_quarter_ring():
    section, force = curved.quarter_section()
    (found,) = curved.displaced(curved.QUARTER, bf.CRBF(8), 8, section, force)
    assert found == pytest.approx(curved.quarter_limit("arc"), abs=1e-12)


@pytest.mark.parametrize("curve", list(curved.curves()))
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_orders_on_curves(curve, order):
    found = curved.converge(curve, bf.CRBF(order), order)
    assert 2 * order - 0.8 < found.order < 2 * order + 0.2, found


def test_a_spline_and_a_polygon_come_close_to_the_ring():
    """A cubic through 4 spans is right to h^4, a polygon of 8 sides to h^2."""
    away = [np.abs(curved.quarter_limit(name) - curved.quarter_limit("arc")).max() for name in curved.curves()]
    assert away[0] == 0.0
    assert away[1] < 3e-6
    assert 1e-4 < away[2] < 1e-3


def test_the_tapered_ring_by_all_kinds():
    """Order 3 of the usage script against order 8; structural forces agree up to their order."""
    exact = curved.tip(curved.tapered(bf.CRBF(8), 6))
    runs = {name: curved.tip(curved.tapered(*element)) for name, element in curved.tapered_elements().items()}
    assert runs["CRBF, order 3"] == pytest.approx(exact, abs=5e-8)
    assert runs["CRBF, order 4"] == pytest.approx(exact, abs=1e-9)
    for name in ("ANCF/CRBF, structural", "shear-rigid", "shear-rigid, stretchable", "order 4, gradients, structural"):
        assert runs[name] == pytest.approx(exact, abs=1e-4)
    assert runs["CRBF, order 4, split"] == pytest.approx(exact, abs=1e-4)


@pytest.mark.slow
def test_paths_and_stability_are_those_of_the_literature(tmp_path):
    """The table of the page, against collocation, shooting and elliptic integrals; Beck's load is known to 6 digits."""
    with threadpool_limits(1):
        part = stability.part(tmp_path)
    (table,) = part.tables
    assert len(table.rows) == 16
    for name, _, _, difference in table.rows:
        assert abs(float(difference)) < (6e-6 if "Beck" in name else 1.5e-6), name
    assert [entry.picture.stat().st_size > 0 for entry in part.entries] == [True] * 6


def test_twelve_bilinear_elements_turn_0_924_of_a_circle():
    run = rollup.main(elements=[], slenderness=(), starts=(1,)).bilinear["1 Gauss point, structural"]
    assert rollup.bilinear_turns(12) == pytest.approx(0.924, abs=5e-4)
    assert run.turns == pytest.approx(rollup.bilinear_turns(12), abs=1e-9)


@pytest.mark.parametrize(("order", "gap"), [(4, 1e-7), (6, 1e-9)])
def test_structural_forces_close_the_circle_in_one_step(order, gap):
    found = rollup.main(elements=[], slenderness=rollup.SLENDERNESS)
    for ratio in rollup.SLENDERNESS:
        run = found.thin[order, ratio]
        assert run.gap < gap
        assert run.steps == 1
        assert run.iterations <= 6


def test_two_circles_in_one_step():
    run = rollup.roll(bf.CRBF(6), 6, 100, 2)
    assert run.gap < 1e-7
    assert run.turns == pytest.approx(2.0, abs=1e-7)
    assert (run.steps, run.iterations <= 6) == (1, True)


@pytest.mark.slow
@pytest.mark.parametrize("turns", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_continuum_forces_turn_as_uniform_bending_does(turns):
    """Energy of a uniformly bent section, no elements."""
    forces = bf.ContinuumMechanics()
    expected = rollup.uniform_turns(forces, Rotation(), 100, turns)
    assert rollup.roll(bf.CRBF(8, forces), 6, 100, turns).turns == pytest.approx(expected, abs=1e-8)
    # a thick beam of this material has a largest moment, below that of two circles
    assert np.isnan(rollup.uniform_turns(forces, Rotation(), 10, 2))
    assert rollup.roll(bf.CRBF(4, forces), 8, 10, 2).failed


def test_roll_up_makes_a_row_for_each_element():
    found = rollup.main(elements=[(bf.CRBF(4), 8), (bf.ANCF(bf.SplitContinuum()), 12)], slenderness=(10,), starts=(1,))
    everything = rollup._tables(found)[0]
    assert [len(row) for row in everything.rows] == [len(everything.header)] * 2
