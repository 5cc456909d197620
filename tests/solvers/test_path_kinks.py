"""Paths under functions of the load factor with kinks: tables, triangles, and what functions do not declare."""

import numpy as np
import pytest

import beamfem as bf

BAR = bf.Beam(bf.Line((0, 0), (100, 0)), 6, bf.CRBF(2), bf.Rectangle(5, 5), bf.Material(2e5, 0.3, 1e-9))
CLAMP = bf.Clamp(BAR.start)


def triangle(f):
    return 1.0 - abs(1.0 - 2.0 * f)


FUNCTIONS = {
    "table from 0 to 1": (bf.Interpolated([(0.0, 0.0), (1.0, 1.0)]), []),
    "table beyond both ends": (bf.Interpolated([(-1.0, -1.0), (2.0, 2.0)]), []),
    "table with a peak": (bf.Interpolated([(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]), [0.5]),
    "table with four kinks": (bf.Interpolated([(0, 0), (0.3, 1), (0.6, 0.25), (0.8, 0.3), (1, 0.6)]), [0.3, 0.6, 0.8]),
    "declared triangle": (bf.Piecewise(triangle, [0.5]), [0.5]),
    "triangle": (triangle, [0.5]),
    "bend": (lambda f: f if f < 0.4 else 0.4 + 0.3 * (f - 0.4), [0.4]),
    "plateau": (lambda f: min(f / 0.7, 1.0), []),
}


@pytest.mark.parametrize("force", [True, False], ids=["force", "motion"])
@pytest.mark.parametrize(("function", "kinks"), FUNCTIONS.values(), ids=FUNCTIONS)
def test_a_path_goes_on_across_kinks_with_a_row_at_each(function, kinks, force):
    """A path under a table from 0 to 1 ended at load factor 0, a triangle at its peak. The end is that of statics."""
    if force:
        model = bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, 1000.0), amplitude=function)])
        plain = bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, 1000.0))])
    else:
        model = bf.Model([BAR], [CLAMP, bf.Prescribed(BAR.end, uy=lambda f: 20.0 * function(f))])
        plain = bf.Model([BAR], [CLAMP, bf.Prescribed(BAR.end, uy=20.0)])
    path = bf.trace_equilibrium(model, 1.0)
    assert path.load_factor[-1] == pytest.approx(1.0, rel=1e-12)
    for kink in kinks:
        assert np.abs(path.load_factor - kink).min() < 1e-9
    assert not path.limit_points
    assert not path.bifurcations
    reached = [function(at) for at in path.load_factor]
    again = bf.trace_equilibrium(plain, max(reached), points=len(path) + 5)
    assert path.displacement(BAR.end)[int(np.argmax(reached)), 1] == pytest.approx(
        again.displacement(BAR.end)[-1, 1], rel=1e-8
    )
    static = bf.solve_static(model)
    assert path.displacement(BAR.end)[-1] == pytest.approx(static.displacement(BAR.end)[-1], rel=1e-7, abs=1e-9)
    assert len(path) < 20


def test_a_path_downward_uses_the_other_side_of_a_kink_at_its_start():
    table = bf.Interpolated([(-1.0, -3.0), (0.0, 0.0), (1.0, 1.0)])
    model = bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, 1000.0), amplitude=table)])
    path = bf.trace_equilibrium(model, -1.0)
    plain = bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, -3000.0))])
    assert path.displacement(BAR.end)[-1] == pytest.approx(bf.solve_static(plain).displacement(BAR.end)[-1], rel=1e-8)


@pytest.mark.parametrize("length", [0.11, 0.43, 2.0, 4.17, 13.7, 145.0, 330.0, 753.0])
@pytest.mark.parametrize("share", [0.03, 0.09, 0.11, 0.27, 0.34, 0.43, 0.48])
def test_a_kink_found_next_to_the_end_of_a_path_is_its_end(length, share):
    """Samples find the end of the table at 1 or 1 - 1e-16; every fifth of such paths stopped in the latter."""
    table = bf.Interpolated([(0.0, 0.0), (0.6, 0.8), (1.0, 1.4)])
    bar = bf.Beam(bf.Line((0, 0), (length, 0)), 4, bf.CRBF(2), bf.Rectangle(length / 90, length / 90), BAR.material)
    lift = bf.Prescribed(bar.end, uy=lambda f: share * length * table(f))
    path = bf.trace_equilibrium(bf.Model([bar], [bf.Clamp(bar.start), lift]), 1.0)
    assert path.load_factor[-1] == 1.0
    assert path.displacement(bar.end)[-1, 1] == pytest.approx(1.4 * share * length, rel=1e-12)


def test_loads_may_begin_to_grow_late():
    """They are flat up to load factor 1; beyond, the path is that of the loads without the flat part."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    ends = []
    for table, until in (([(0, 0), (1, 0), (2, 1)], 2.0), ([(0, 0), (1, 1)], 1.0)):
        push = bf.PointForce(beam.end, (0.0, 100.0), amplitude=bf.Interpolated(table))
        path = bf.trace_equilibrium(bf.Model([beam], [bf.Clamp(beam.start)], [push]), until=until)
        ends.append(path.displacement(beam.end)[-1])
    assert ends[0] == pytest.approx(ends[1], rel=1e-10)


STRIP = bf.Rectangle(0.01, 0.005), bf.Material(2.1e11, 0.3, 7850.0)
HALF = bf.Beam(bf.Line((-1, 0), (0, 0.1)), 4, bf.CRBF(3), *STRIP)
SYMMETRY = bf.Clamp(HALF.start), bf.Prescribed(HALF.end, ux=0.0, rotation=0.0)
TOGGLE = bf.Model([HALF], SYMMETRY, [bf.PointForce(HALF.end, (0.0, -50.0))])


@pytest.mark.filterwarnings("ignore::beamfem.UnstableWarning")
@pytest.mark.parametrize(("height", "stiffness"), [(0.05, 1e8), (0.02, 3e3), (0.02, 1e5), (-0.03, 1e5)])
def test_a_snapping_toggle_is_caught_by_a_stop(height, stiffness):
    """Half of such paths ended there. A stop that ends the fall of the load factor makes a limit point at its place."""
    stop = bf.Stop(HALF.end, (0.0, height), (0.0, 1.0), stiffness)
    path = bf.trace_equilibrium(TOGGLE.with_(connectors=[stop]), until=6.0)
    high, low = path.limit_points
    assert high.at == pytest.approx(3.0912387, rel=1e-6)
    at = float(low.position(HALF.end)[1])
    if height > -0.02 and stiffness > 1e4:
        assert at == pytest.approx(height, abs=1e-6)
    held = bf.Model([HALF], [SYMMETRY[0], bf.Prescribed(HALF.end, ux=0.0, uy=at - 0.1, rotation=0.0)])
    by_beams = -bf.solve_static(held).reaction(HALF.end)[-1, 1] / 50.0
    assert low.at == pytest.approx(by_beams + max(height - at, 0.0) * stiffness / 50.0, abs=1e-4)
    assert path.load_factor[-1] == 6.0


def test_a_path_over_a_stop_ends_in_the_state_of_statics():
    stop = bf.Stop(BAR.end, (100.0, -3.0), (0.0, 1.0), 1e6)
    model = bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (-50.0, -1000.0))], connectors=[stop])
    path, static = bf.trace_equilibrium(model, 1.0), bf.solve_static(model)
    np.testing.assert_allclose(path.position(BAR.end)[-1], static.position(BAR.end)[-1], rtol=0, atol=1e-9)
    assert len(path) < 30
    assert not bf.solve_buckling(model, 1).load_factors.size
