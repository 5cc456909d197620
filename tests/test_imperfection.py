"""Models that are crooked by a mode: growth of imperfections, and what stays where it was."""

import numpy as np
import pytest
from connectors import SpringDamper

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SQUARE = bf.Rectangle(0.01, 0.01)
EULER = np.pi**2 * 2e11 * 1e-8 / 12.0


def column(force, turn=0.0):
    c, s = np.cos(turn), np.sin(turn)
    own = bf.Beam(bf.Line((1.0, 2.0), (1.0 + c, 2.0 + s)), 8, bf.CRBF(3), SQUARE, STEEL)
    held = [bf.Pin(own.start), bf.Roller(own.end, (-s, c))]
    return bf.Model([own], held, [bf.PointForce(own.end, (-force * c, -force * s))])


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_an_imperfection_of_a_column_grows_as_youngs_says(turn, share):
    """A sine of height a grows by a P / (P_cr - P)."""
    perfect = column(share * EULER, turn)
    crooked = perfect.with_imperfection(bf.solve_buckling(perfect), size=1e-5)
    middle = crooked.beams[0].at(0.5)
    moved = bf.solve_static(crooked).displacement(middle)[-1]
    assert np.linalg.norm(moved - moved @ [np.cos(turn), np.sin(turn)] * np.array([np.cos(turn), np.sin(turn)])) == (
        pytest.approx(1e-5 * share / (1.0 - share), rel=3e-3)
    )


def test_it_is_as_large_as_asked_and_free_of_stress():
    perfect = column(1.0)
    crooked = perfect.with_imperfection(bf.solve_buckling(perfect), size=-0.02)
    at_rest = bf.Model(crooked.beams, crooked.supports)
    solution = bf.solve_static(at_rest)
    assert solution.energy().strain[-1] == pytest.approx(0.0, abs=1e-15)
    shift = crooked.beams[0].at(0.5).reference - perfect.beams[0].at(0.5).reference
    assert np.linalg.norm(shift) == pytest.approx(0.02, rel=1e-4)
    other = perfect.with_imperfection(bf.solve_buckling(perfect), size=0.02)
    assert other.beams[0].at(0.5).reference - perfect.beams[0].at(0.5).reference == pytest.approx(-shift, abs=1e-9)


def frame():
    """Two bars at a corner, one with a corner and a taper of its own, with all that may stand on them."""
    left = bf.Beam(bf.Polyline([(0.0, 0.0), (0.0, 0.5), (0.1, 1.0)]), 4, bf.CRBF(3), SQUARE, STEEL)
    taper = bf.Piecewise(lambda s: bf.Rectangle(0.01, 0.01 if s < 0.4 else 0.012), [0.4])
    right = bf.Beam(bf.Line((0.1, 1.0), (1.1, 1.0)), 4, bf.CRBF(2), taper, STEEL)
    supports = [bf.Clamp(left.start), bf.Pin(right.end), bf.Spring(right.at(0.3), (10.0, 20.0))]
    loads = [
        bf.PointForce(right.at(0.62), (0.0, -20.0)),
        bf.DistributedLoad(right, lambda s: (0.0, -10.0 if s < 0.7 else 0.0)),
        bf.Gravity((0.0, -9.81)),
    ]
    spring = SpringDamper(left.at(0.5), right.at(0.5), 100.0)
    return bf.Model([left, right], supports, loads, [bf.Rigid(left.end, right.start)], [spring], units="N, m")


def test_everything_stays_at_its_point():
    perfect = frame()
    modes = bf.solve_modes(perfect, count=2, about=bf.solve_static(perfect))
    tiny, none = perfect.with_imperfection(modes, 1e-7, mode=1), perfect.with_imperfection(modes, 0.0)
    assert [type(item) for item in tiny.loads] == [type(item) for item in perfect.loads]
    ends = [bf.solve_static(model) for model in (perfect, none, tiny)]
    tips = [solution.position(solution.model.beams[1].at(0.62))[-1] for solution in ends]
    assert tips[1] == pytest.approx(tips[0], abs=1e-9)
    assert tips[2] == pytest.approx(tips[0], abs=1e-5)
    places = [[support.point.reference for support in model.supports] for model in (perfect, tiny)]
    assert np.array(places[1]) == pytest.approx(np.array(places[0]), abs=2e-7)
    assert tiny.beams[0].curve.corners[0] == pytest.approx(0.5, abs=1e-6)
    assert tiny.units == "N, m"


def test_a_crooked_model_is_saved_and_loaded(tmp_path):
    perfect = column(0.5 * EULER)
    crooked = perfect.with_imperfection(bf.solve_buckling(perfect), size=1e-3)
    solution = bf.solve_static(crooked)
    solution.save(tmp_path / "crooked.h5")
    again = bf.load(tmp_path / "crooked.h5")
    assert again.position(again.model.beams[0].at(0.5))[-1] == pytest.approx(
        solution.position(crooked.beams[0].at(0.5))[-1], abs=1e-12
    )


def test_what_makes_no_imperfection_is_refused():
    model, other = column(1.0), frame()
    buckling = bf.solve_buckling(model)
    for given, said in ((bf.solve_modes(other, 1, bf.solve_static(other)), "coordinates"), ("sine", "coordinates")):
        with pytest.raises(bf.InputError, match=said):
            model.with_imperfection(given, 1e-3)
    with pytest.raises(bf.InputError, match="mode"):
        model.with_imperfection(buckling, 1e-3, mode=5)
    with pytest.raises(bf.InputError, match="size"):
        model.with_imperfection(buckling, np.nan)
    with pytest.raises(bf.InputError, match="moves no point"):
        model.with_imperfection(np.zeros(model.size), 1e-3)
