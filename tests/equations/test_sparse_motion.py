"""Motion of models whose tangent is sparse, against that of the band and rigid motion."""

import numpy as np
import pytest
from test_sparse import MATERIAL, SECTION, grid

import beamfem as bf
from beamfem.equations.equations import tangent_of
from beamfem.equations.system import system_of
from beamfem.solve.motion import coupled_stages


def arcade(bays=3):
    """Portals side by side with hinges, an inclined roller, a driven foot and a follower that shakes them."""
    posts = [bf.Beam(bf.Line((i, 0), (i, 1)), 2, bf.CRBF(2), SECTION, MATERIAL) for i in range(bays + 1)]
    tops = [bf.Beam(bf.Line((i, 1), (i + 1, 1)), 2, bf.CRBF(2), SECTION, MATERIAL) for i in range(bays)]
    joints = [bf.Rigid(posts[i].end, top.start) for i, top in enumerate(tops)]
    joints += [(bf.Hinge, bf.Rigid)[i % 2](posts[i + 1].end, top.end) for i, top in enumerate(tops)]
    supports = [bf.Clamp(posts[0].start), *(bf.Pin(post.start) for post in posts[1:-2])]
    supports += [bf.Roller(posts[-1].start, (0.6, 0.8)), bf.Prescribed(posts[-2].start, 0.0, lambda t: 0.01 * t * t)]
    loads = [
        bf.Gravity((0.0, -9.81)),
        bf.PointForce(tops[-1].at(0.3), (20.0, 5.0), amplitude=lambda t: np.sin(20.0 * t), follower=True),
    ]
    return bf.Model([*posts, *tops], supports, loads, joints)


def largest_difference(one, other, name):
    a, b = getattr(one, name), getattr(other, name)
    return np.abs(a - b).max() / np.abs(a).max()


def test_a_motion_is_that_of_the_band(widest_band):
    def run():
        return bf.simulate(arcade(), 0.3, 0.005, save_every=3)

    band = run()
    widest_band(-1)
    sparse = run()
    assert np.array_equal(band.time, sparse.time)
    # positions to 1e-12 of the model in a step; rates are differences of them over steps of 5 ms
    for name, tolerance in (("p", 1e-10), ("v", 1e-8), ("a", 1e-6)):
        assert largest_difference(band, sparse, name) < tolerance


def test_a_lattice_moves_as_with_the_band(widest_band):
    def run():
        model, ends = grid(23, 23, force=(3.0, -5.0))
        solution = bf.simulate(model, 0.05, 0.005)
        return solution, solution.displacement(ends[23, 23][0]), system_of(model, static=False).unknowns.pattern

    sparse, moved, pattern = run()
    assert pattern is not None
    assert sparse.iterations <= 5 * 10
    widest_band(10_000)
    band, expected, pattern = run()
    assert pattern is None
    assert np.abs(moved - expected).max() < 1e-9 * np.abs(expected).max()
    assert abs(sparse.energy().kinetic[-1] / band.energy().kinetic[-1] - 1.0) < 1e-8


def test_a_loose_lattice_falls_and_turns_as_a_rigid_body():
    """Free fall is exact for constant acceleration; a slow turn keeps its momentum, members hardly strain."""
    model, ends = grid(23, 23)
    turn = bf.RigidVelocity((1.0, 2.0), angular=0.1, about=(11.5, 11.5))
    model = bf.Model(model.beams, (), [bf.Gravity((0.0, -9.81))], model.joints)
    solution = bf.simulate(model, 0.1, 0.01, velocity=turn)
    time, mass = solution.time, solution.linear_momentum()[0, 0]
    momentum = np.column_stack([np.full_like(time, mass), mass * (2.0 - 9.81 * time)])
    assert np.abs(solution.linear_momentum() - momentum).max() < 1e-9 * mass
    middle = sum(solution.displacement(ends[i, j][0]) for i in (0, 23) for j in (0, 23)) / 4.0
    assert np.abs(middle[:, 1] - (2.0 * time - 0.5 * 9.81 * time**2)).max() < 1e-4


def test_a_step_that_fails_hands_back_the_states_before(widest_band):
    widest_band(-1)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(), SECTION, MATERIAL)
    model = bf.Model([one], loads=[bf.PointForce(one.end, (1e15, 0.0), amplitude=lambda t: float(t > 0.055))])
    with pytest.raises(bf.ConvergenceError, match=r"from 0\.05 s to 0\.06 s did not converge") as caught:
        bf.simulate(model, 0.1, 0.01)
    assert len(caught.value.solution) == 6
    assert np.isfinite(caught.value.solution.p).all()


@pytest.mark.parametrize("force", [1e-9, 1e-6, 1e-3])
def test_a_small_motion_needs_one_tangent_and_two_corrections_a_step(widest_band, monkeypatch, force):
    """Its equations are linear: one correction solves a step, a second proves it, however small the motion is.

    Under 1e-9 N it moves by so little that corrections end in the round-off of positions: it takes a few more, and as
    that grows with the motion from nothing, new tangents to tell it from corrections that a kept one does not see. Each
    of them allows for twice the round-off, which grows from 1e-17 to 1e-16.
    """
    widest_band(-1)
    tangents = []

    def counted(*given):
        tangents.append(given)
        return tangent_of(*given)

    monkeypatch.setattr(coupled_stages, "tangent_of", counted)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SECTION, MATERIAL)
    push = bf.PointForce(beam.end, (0.0, force), amplitude=lambda t: np.sin(20.0 * t))
    solution = bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)], [push]), 0.4, 0.01)
    assert 2 * 40 <= solution.iterations <= (2 if force > 1e-8 else 4) * 40
    assert len(tangents) <= (1 if force > 1e-8 else 5)
