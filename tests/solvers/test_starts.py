"""What `start` and `about` take: a state, or any solution for its last state, in every solver alike."""

import numpy as np
import pytest

import beamfem as bf

STEEL, SQUARE = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.05, 0.05)


@pytest.fixture(scope="module")
def pushed():
    """A clamped column under a vertical load of a third of Euler's."""
    beam = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(2), SQUARE, STEEL)
    force = (0.0, -SQUARE.rigidity(STEEL).bending)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)])


def test_a_motion_starts_from_the_last_state_of_a_solution_as_from_the_state(pushed):
    """`simulate` refused a solution, which `solve_modes` and `solve_buckling` took."""
    static, path = bf.solve_static(pushed, steps=2), bf.trace_equilibrium(pushed, until=1.0)
    motion = bf.simulate(pushed, 1e-3, 1e-4, velocity=bf.RigidVelocity((0.1, 0.0)))
    for solution in (static, path, motion):
        ways = [bf.simulate(pushed, 1e-4, 1e-4, start=start) for start in (solution, solution[-1])]
        assert np.array_equal(ways[0].p, ways[1].p)
        assert np.array_equal(ways[0].p[0], solution[-1].p)
        assert np.array_equal(ways[0].v[0], ways[1].v[0])


def test_modes_and_buckling_are_about_the_last_state_of_a_solution_as_about_the_state(pushed):
    static, path = bf.solve_static(pushed), bf.trace_equilibrium(pushed, until=1.0)
    exact = bf.solve_modes(pushed, 2, static[-1]).frequencies
    for about in (static, path, path[-1]):
        assert bf.solve_modes(pushed, 2, about).frequencies == pytest.approx(exact, rel=1e-8)
        # shear lowers Euler's load by a thousandth at L / h = 20
        assert bf.solve_buckling(pushed, 1, about).load_factors == pytest.approx(np.pi**2 / 4.0, rel=1.2e-3)
    motion = bf.simulate(pushed, 1e-4, 1e-4)
    for solve in (bf.solve_modes, bf.solve_buckling):
        with pytest.raises(bf.InputError, match="this solution is a motion"):
            solve(pushed, 1, motion)
        with pytest.raises(bf.InputError, match=r"about must be a state, such as .* or a solution, got a str"):
            solve(pushed, 1, "reference")


def test_a_motion_starts_in_a_mode_and_vibrates_in_it(pushed):
    """About the equilibrium under a third of Euler's load: after half a period it is on the other side."""
    modes = bf.solve_modes(pushed, 2, bf.solve_static(pushed))
    tip = pushed.beams[0].end
    for number, frequency in enumerate(modes.frequencies.tolist()):
        begin, half = modes.start(number, 1e-5), 0.5 / frequency
        motion = bf.simulate(pushed, half, half / 200, bf.GeneralizedAlpha(1.0), start=begin)
        moved = motion.p - modes.state.p
        size = np.abs(moved[0]).max()
        np.testing.assert_allclose(moved[-1], -moved[0], atol=2e-3 * size)
        assert abs(motion.displacement(tip)[0, 0]) == pytest.approx(1e-5, rel=1e-3)


def test_a_motion_starts_in_a_rigid_mode_with_its_velocity():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    model = bf.Model([beam], [bf.Pin(beam.start)])
    motion = bf.simulate(model, 1e-2, 1e-4, start=bf.solve_modes(model, 2).start(0, 0.1))
    assert abs(motion.displacement(beam.end)[-1, 1]) == pytest.approx(1e-3, rel=1e-4)
