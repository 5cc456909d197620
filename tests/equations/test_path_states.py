"""Where paths go and end, and what their rows say of stability, against closed forms and modes of vibration."""

import numpy as np
import pytest
from test_path import LIMIT_HEIGHT, WILLIAMS, bar, bar_force, cantilever, toggle

import beamfem as bf
from beamfem.solve.paths.trace import trace_equilibrium


def test_a_path_to_a_negative_load_factor_goes_downward():
    beam, model = bar()
    path = trace_equilibrium(model, until=-0.5)
    assert path.load_factor[-1] == -0.5
    assert np.all(np.diff(path.load_factor) < 0.0)
    deflection = -path.displacement(beam.end)[:, 1]
    assert bar_force(deflection) == pytest.approx(path.load_factor, abs=1e-11)
    assert deflection[-1] < 0.0
    assert path.limit_points == ()


def test_the_direction_is_the_users_where_it_is_given():
    beam, model = bar()
    down = trace_equilibrium(model, points=6, direction=-1)
    assert np.all(np.diff(down.load_factor) < 0.0)
    below = trace_equilibrium(model, -0.01, direction=-1)
    above = trace_equilibrium(model, -0.01, direction=1)
    assert below.load_factor[-1] == above.load_factor[-1] == -0.01
    assert below.displacement(beam.end)[-1, 1] > 0.0 > above.displacement(beam.end)[-1, 1]
    assert trace_equilibrium(model, 0.005, direction=1).load_factor[-1] == 0.005


def test_a_prescribed_motion_is_followed_backward():
    """Half of a strip bent to a circle by turning its end: M = E I theta / L, either way."""
    beam, _ = cantilever(1000, (0.0, 1.0), nu=0.0)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=np.pi)])
    path = trace_equilibrium(model, -1.0)
    assert path.load_factor[-1] == -1.0
    assert path.reaction(beam.end)[-1, 2] == pytest.approx(-np.pi, rel=1e-6)


@pytest.mark.parametrize("element", [bf.ANCF(), bf.CRBF(2)])
def test_a_support_turns_by_less_than_a_radian_in_a_step(element):
    """Gradients cannot tell a full turn from none; a lever is small beside the beam that rests."""
    section, rubber = bf.Rectangle(0.01, 0.01), bf.Material(1e9, 0.0, 1.0)
    girder = bf.Beam(bf.Line((0, 0), (20, 0)), 4, element, bf.Rectangle(0.5, 0.5), rubber)
    lever = bf.Beam(bf.Line((0, 1), (0.4, 1)), 16, element, section, rubber)
    turning = bf.Prescribed(lever.end, rotation=4.0 * np.pi)
    supports = [bf.Clamp(girder.start), bf.Prescribed(lever.start, ux=0.0, uy=0.0, rotation=0.0), turning]
    path = trace_equilibrium(bf.Model([girder, lever], supports, [bf.PointForce(girder.end, (0.0, -1.0))]), 1.0)
    angle = path.rotation(lever.end)
    assert np.abs(np.diff(angle)).max() <= 1.0 + 1e-9
    assert angle[-1] == pytest.approx(4.0 * np.pi, rel=1e-9)
    assert path.rotation(lever.at(0.5))[-1] == pytest.approx(2.0 * np.pi, rel=1e-6)


def test_a_limit_point_beyond_the_end_of_the_path_is_not_listed():
    limit = bar_force(0.4 - LIMIT_HEIGHT)
    _, model = bar()
    assert trace_equilibrium(model, 0.9999 * limit).limit_points == ()
    path = trace_equilibrium(model, lambda state: state.load_factor < 0.0)
    assert len(path.limit_points) == 1


def test_rows_are_unstable_between_the_limit_points():
    beam, model = toggle()
    path = trace_equilibrium(model, 80.0)
    deflection = -path.displacement(beam.end)[:, 1]
    first, second = (-found.displacement(beam.end)[1] for found in path.limit_points)
    assert np.array_equal(path.stable, (deflection < first) | (deflection > second))
    assert not path.stable.all()
    assert [state.stable for state in path] == path.stable.tolist()
    assert not any(found.stable for found in path.limit_points)


def test_the_straight_column_is_unstable_above_its_buckling_load_and_its_branch_is_stable():
    _, model = cantilever(10, (0.0, -1.0))
    path = trace_equilibrium(model, 3.0)
    (crossing,) = path.bifurcations
    assert np.array_equal(path.stable, path.load_factor < crossing.load_factor)
    assert not crossing.stable
    branch = trace_equilibrium(model, 3.0, start=crossing)
    assert branch.stable.tolist() == [False, *[True] * (len(branch) - 1)]


@pytest.mark.parametrize("follower", [False, True])
def test_what_rows_say_of_stability_is_what_vibration_about_them_says(follower):
    """A shallow pinned arch under a force on its crown, dead or turning with it, past its first limit point."""
    section = bf.Rectangle(0.02, 0.02)
    arch = bf.Beam(
        bf.Parametric(lambda u: (u, 0.08 * np.sin(np.pi * u)), 0.0, 1.0),
        6,
        bf.CRBF(3),
        section,
        bf.Material(1e9, 0.3, 1e3),
    )
    load = bf.PointForce(arch.at(0.45), (0.0, -1.0), follower=follower)
    model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [load])
    path = trace_equilibrium(model, points=16)
    assert len(path.limit_points) >= 1
    growth = np.array([bf.solve_modes(model, 3, about=state).growth.max() for state in path])
    assert np.array_equal(path.stable, growth == 0.0)
    assert 0 < path.stable.sum() < len(path)


def test_states_of_a_path_count_turns_and_files_keep_them(tmp_path):
    """A toggle, and beside it a bar that its prescribed end swings by 0.12 rad per unit of the load factor.

    So the bar's rotation is known at every load factor: 4.1 rad at the first limit point. In a file the functions that
    swing it have their values at the limit points too, where reactions and section forces need them.
    """
    crown, alone = toggle()
    bar = bf.Beam(bf.Line((0, 5), (2, 5)), 2, bf.ANCF(), bf.Rectangle(0.1, 0.1), bf.Material(1e4, 0.3, 1.0))
    swung = bf.Prescribed(
        bar.end, ux=lambda load: 2.0 * np.cos(0.12 * load) - 2.0, uy=lambda load: 2.0 * np.sin(0.12 * load)
    )
    model = bf.Model([crown, bar], [*alone.supports, bf.Pin(bar.start), swung], alone.loads)
    path = trace_equilibrium(model, 50.0)
    path.save(tmp_path / "path.h5")
    loaded = bf.load(tmp_path / "path.h5")
    assert path.limit_points[0].load_factor == pytest.approx(WILLIAMS[0][0], rel=1e-8)
    for found in (path, loaded):
        crown, bar = found.model.beams
        np.testing.assert_allclose(found.rotation(bar.end), 0.12 * found.load_factor, atol=1e-9)
        for state in (*found.limit_points, found[-1], found[len(found) // 2]):
            assert state.rotation(bar.end) == pytest.approx(0.12 * state.load_factor, abs=1e-9)
        state = found.limit_points[0]
        assert not state.stable
        assert state.section_forces(crown).normal[0] == pytest.approx(-631.9, rel=2e-3)  # thrust of the reference
        marks = found.plot_load_displacement(bar.end, "rotation").axes[0].lines[2]
        np.testing.assert_allclose(marks.get_xdata(), 0.12 * marks.get_ydata(), atol=1e-9)
