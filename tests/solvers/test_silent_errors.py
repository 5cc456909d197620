"""What was wrong without a word: cusps, buckling loads of locking elements, light rings, lost rows and warnings."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf

STEEL, SQUARE = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
BENDING = 2e11 * 1e-8 / 12
LINE = bf.ANCF(bf.ElasticLine())


def joined(number, force):
    halves = [bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), number, LINE, SQUARE, STEEL) for x in (0.0, 0.5)]
    load = bf.PointForce(halves[1].end, (0.0, force * BENDING))
    return halves[1], bf.Model(halves, [bf.Clamp(halves[0].start)], [load], [bf.Rigid(halves[0].end, halves[1].start)])


@pytest.mark.parametrize(("number", "force"), [(2, 10.0), (4, 10.5), (8, 12.0), (12, 30.0)])
def test_one_step_of_two_joined_lines_ends_where_many_do(number, force):
    """Against the same cantilever as one beam of cubic rotations, and against 20 steps."""
    half, model = joined(number, force)
    once, often = (bf.solve_static(model, steps=steps) for steps in (1, 20))
    np.testing.assert_allclose(once.displacement(half.end)[-1], often.displacement(half.end)[-1], atol=1e-6)
    assert once.rotation(half.start)[-1] == pytest.approx(often.rotation(half.start)[-1], abs=1e-5)
    assert not any("cusp" in sentence for sentence in (*once.warnings, *often.warnings))
    whole = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), SQUARE, STEEL)
    load = [bf.PointForce(whole.end, (0.0, force * BENDING))]
    right = bf.solve_static(bf.Model([whole], [bf.Clamp(whole.start)], load)).displacement(whole.end)[-1]
    np.testing.assert_allclose(once.displacement(half.end)[-1], right, atol=0.06 if number == 2 else 0.01)


@pytest.mark.parametrize(
    ("element", "elements", "notch", "size"),
    [
        (bf.CRBF(8), 20, (0.5, 0.05, 0.9), 5.0),
        (bf.CRBF(4), 8, (0.5, 0.05, 0.9), 5.0),
        (bf.CRBF(2), 7, (0.7, 0.1, 0.95), 0.5),
    ],
)
def test_one_step_does_not_wind_up_a_notch(element, elements, notch, size):
    """A transverse force turns no section of a straight cantilever beyond its own direction; it was 7.7, 26.7, 2.5 rad.

    On the way, sections turn towards the force only: theta'' = -P cos(theta) / E I, with E I the smaller the thinner.
    """

    middle, width, depth = notch

    def notched(s):
        return bf.Rectangle(0.02, 0.01 * (1.0 - depth * np.exp(-(((s - middle) / width) ** 2))))

    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, notched, STEEL)
    force = bf.PointForce(beam.end, (0.0, size * 2e11 * bf.Rectangle(0.02, 0.01).second_moment))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [force])
    once, often = bf.solve_static(model), bf.solve_static(model, steps=20)
    assert 0.0 < once.rotation(beam.end)[-1] < 0.5 * np.pi
    np.testing.assert_allclose(once.position(beam.end)[-1], often.position(beam.end)[-1], atol=1e-6)


def test_one_step_round_a_corner_ends_where_many_do():
    angle = bf.Beam(bf.Polyline(((0, 0), (0, 0.5), (0.5, 0.5))), 12, LINE, SQUARE, STEEL)
    load = [bf.PointForce(angle.end, (0.0, 13.5 * BENDING))]
    model = bf.Model([angle], [bf.Clamp(angle.start)], load)
    once, often = (bf.solve_static(model, steps=steps).displacement(angle.end)[-1] for steps in (1, 20))
    np.testing.assert_allclose(once, often, atol=1e-6)


def test_a_state_with_a_cusp_is_warned_of():
    """Reversed by hand: the stretch of r_x at the joint, on the side of the second beam."""
    half, model = joined(4, 5.0)
    bent, stretch = bf.solve_static(model), model.mesh_of(half.start).coordinates_of(0)["s"]
    for solution, state in (bent, "this equilibrium"), (bf.simulate(model, 1e-4, 1e-4), "this state of the motion"):
        p = solution.p.copy()
        p[-1, stretch] *= -1.0
        assert any(f"{state} has a cusp" in sentence for sentence in replace(solution, p=p).warnings)


@pytest.mark.parametrize("element", [bf.BilinearCRBF(), bf.BilinearANCF(), bf.CRBF(1, integration="full")])
def test_buckling_loads_of_locking_elements_are_warned_of(element):
    """They are thousands of times too high in slender columns."""
    column = bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, bf.Rectangle(0.001, 0.001), STEEL)
    load = [bf.PointForce(column.end, (-(2e11 * 1e-12 / 12), 0.0))]
    with pytest.warns(bf.LockingWarning, match="without locking a critical load factor would change by"):
        bf.solve_buckling(bf.Model([column], [bf.Clamp(column.start)], load))


def test_warnings_of_amplitudes_between_rows_are_kept():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(3), SQUARE, STEEL)
    load = bf.PointForce(beam.end, (0, 100.0), amplitude=lambda t: np.sin(2 * np.pi * 200.1 * t))
    with pytest.warns(UserWarning, match="varies more between load factors"):
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))
    assert any("varies more between load factors" in sentence for sentence in solution.warnings)


@pytest.mark.parametrize(("elements", "error"), [(4, True), (8, True), (32, False)])
def test_curved_bodies_with_short_sections_are_warned_of(elements, error):
    """Directors between unit vectors that differ by an angle are shorter; half a ring of 4 elements weighs 5 % less."""
    ring = bf.Beam(
        bf.Arc((0, 0), 1, 0, np.pi), elements, bf.ANCF(bf.SplitContinuum(), integration="lobatto"), SQUARE, STEEL
    )
    model = bf.Model([ring], [bf.Clamp(ring.start)], [bf.Gravity((0, -9.81))])
    if error:
        with pytest.warns(bf.LockingWarning, match="too short between the nodes of its curved elements"):
            solution = bf.solve_static(model)
    else:
        solution = bf.solve_static(model)
    missing = 1.0 - solution.reaction(ring.start)[-1, 1] / (7800.0 * 1e-4 * 9.81 * np.pi)
    assert (missing > 0.01) == error


@pytest.mark.parametrize("first", [0.0003, 0.001, 0.0019])
def test_the_peak_shear_stress_of_layers_is_that_of_the_whole(first):
    """1.5 V / A, at the neutral axis inside a layer."""
    layers = [bf.Layer(STEEL, first), bf.Layer(STEEL, 0.004 - first)]
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Layered(layers, width=0.01))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -1e-3))]))
    assert solution.stresses(beam).peak("shear").value == pytest.approx(1.5 * 1e-3 / 4e-5, rel=1e-9)
