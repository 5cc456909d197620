"""Models that are crooked by a mode: growth of imperfections, and what stays where it was."""

from dataclasses import dataclass
from typing import NamedTuple

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


@pytest.mark.parametrize("elements", [4, 16])
def test_modes_about_a_bent_state_are_as_smooth_as_it_is(elements):
    """Slopes of nodes without shear are products with the state's own directions."""
    turns = []
    for element in (bf.CRBF(4), bf.ShearRigid()):
        own = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.02, 0.01), STEEL)
        force = 3 * 2e11 * 0.02 * 0.01**3 / 12
        model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0.0, force))])
        crooked = model.with_imperfection(bf.solve_modes(model, 2, about=bf.solve_static(model)), 0.05).beams[0].curve
        tangent = crooked.tangent(np.linspace(0.0, 1.0, 801) * crooked.length)
        turns.append(np.abs(np.diff(np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0])))).sum())
    assert turns[1] == pytest.approx(turns[0], rel=0.05)


@pytest.mark.parametrize("element", [bf.CRBF(1), bf.BilinearCRBF(), bf.BilinearANCF()], ids=lambda own: own.name)
def test_linear_fields_make_smooth_curves_too(element):
    """Their slopes jump at nodes, where sections turn as the axis does."""
    curvatures = []
    for kind in (bf.CRBF(3), element):
        own = bf.Beam(bf.Line((0, 0), (1, 0)), 16, kind, bf.Rectangle(0.02, 0.01), STEEL)
        force = bf.PointForce(own.end, (-1.0, 0.0))
        model = bf.Model([own], [bf.Pin(own.start), bf.Roller(own.end)], [force])
        crooked = model.with_imperfection(bf.solve_buckling(model), 0.05).beams[0].curve
        tangent = crooked.tangent(np.linspace(0.01, 0.99, 400) * crooked.length)
        curvatures.append(np.abs(np.diff(np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0])))).max())
    assert curvatures[1] == pytest.approx(curvatures[0], rel=0.1)


def test_nothing_moves_without_size_however_high_the_order():
    own = bf.Beam(bf.Arc((0, 0), 1.0, np.pi, 0.0), 2, bf.CRBF(8), bf.Rectangle(0.05, 0.05), STEEL)
    held = [bf.Clamp(own.start), bf.Clamp(own.end)]
    model = bf.Model([own], held, [bf.PointForce(own.at(0.5), (1e4, -1e5))])
    same = model.with_imperfection(bf.solve_modes(model, 3), 0.0)
    tips = [bf.solve_static(each).displacement(each.beams[0].at(0.5))[-1] for each in (model, same)]
    assert tips[1] == pytest.approx(tips[0], rel=2e-6)


class Places(NamedTuple):
    first: bf.Point
    second: bf.Point


@dataclass(frozen=True)
class Between(SpringDamper):
    """A spring that keeps its points in a tuple with names."""

    a: Places
    b: float = 0.0

    @property
    def points(self):
        return tuple(self.a)


class Plain:
    """A spring that is no dataclass."""

    unknowns, conservative = 0, False

    def __init__(self, point):
        self.points = (point,)

    def force(self, at):
        return 1e3 * (at.q[0] - at.reference[0])

    def energy(self, at):
        return 0.0, 0.0


def test_connectors_keep_their_points_or_are_named():
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SQUARE, STEEL)
    places = Places(own.at(0.25), own.at(0.75))
    model = bf.Model([own], [bf.Clamp(own.start)], connectors=[Between(places, 0.0, 100.0)])
    crooked = model.with_imperfection(np.arange(model.size) * 1.0, 1e-3)
    assert crooked.connectors[0].points[1].beam is crooked.beams[0]
    free = bf.Model([own], [bf.Clamp(own.start)], connectors=[Plain(own.at(0.5))])
    with pytest.raises(bf.InputError, match="the points of Plain cannot be moved"):
        free.with_imperfection(np.arange(free.size) * 1.0, 1e-3)


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
    with pytest.raises(bf.InputError, match="displaces no point"):
        model.with_imperfection(np.zeros(model.size), 1e-3)


def test_it_keeps_the_rotating_frame_and_the_units():
    blade = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SQUARE, STEEL)
    turning = bf.Model([blade], [bf.Clamp(blade.start)], units="N, m", frame=bf.RotatingFrame(10.0))
    crooked = turning.with_imperfection(bf.solve_modes(turning, 1), size=1e-4)
    assert (crooked.frame, crooked.units) == (turning.frame, "N, m")
