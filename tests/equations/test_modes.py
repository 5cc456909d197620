"""Vibration against closed forms and references computed without any beam code."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackNoConvergence

import beamfem as bf
from beamfem.equations.equations import INERTIA, STATICS, linearise
from beamfem.equations.system import System, system_of
from beamfem.linalg.eigenpairs import first_that_works, general_pairs, nothing_known
from beamfem.solve.modes.modes import _rates
from beamfem.solve.modes.pencil import UNROTATED, Pencil

STEEL = bf.Material(2e11, 0.3, 7800.0)
# 9.timoshenko.clamped-free.L/h=10.ks=5/6 [Hz]
CLAMPED = [81.1554844278, 486.392833885, 1279.28741676, 2320.58635426]
CLAMPED += [3532.56452758, 4854.96394431, 6248.36443121, 7686.40775305]
# 9.timoshenko.free-free.L/h=10.ks=5/6 [Hz]
FREE = [502.714639119, 1307.65740193, 2385.22559166, 3639.5495057]
FREE += [5005.54531925, 6438.46560333, 7908.60643892, 9395.35262918]
# 9.axial [Hz], below the eighth bending mode
AXIAL_CLAMPED = [1265.9242088546, 3797.7726265637, 6329.6210442729]
AXIAL_FREE = [2531.8484177092, 5063.6968354183, 7595.5452531275]
# 9.hanging.pinned.I=8.533e-06.ks=5/6 [rad/s]
HANGING = [3.3623295908, 11.0874011563, 24.8057132271, 41.0713515312]
HANGING += [58.0545918289, 74.7354163028, 84.7380733717, 89.7838274609]


def thick(element, elements, start=(0.0, 0.0), end=(1.0, 0.0)):
    return bf.Beam(bf.Line(start, end), elements, element, bf.Rectangle(0.1, 0.1), STEEL)


def rubber(end, elements=16, youngs_modulus=0.7e6):
    section = bf.Section(area=1.6e-3, second_moment=8.533e-6)
    return bf.Beam(bf.Line((0, 0), end), elements, bf.CRBF(4), section, bf.Material(youngs_modulus, 0.3, 5540.0))


@pytest.mark.parametrize(("elements", "tolerance"), [(16, 3e-6), (60, 1e-8)], ids=["dense", "sparse"])
def test_clamped_free_spectrum_is_exact_and_complete(elements, tolerance):
    """Bending and axial modes of the reference, merged: as many as there are below the last, none besides."""
    beam = thick(bf.CRBF(4), elements)
    exact = np.sort(CLAMPED + AXIAL_CLAMPED)
    modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), len(exact))
    assert modes.frequencies == pytest.approx(exact, rel=tolerance)
    assert modes.rigid == ()
    assert np.all(modes.growth == 0.0)
    assert np.all(modes.modes[:, :2] == 0.0)


@pytest.mark.parametrize(("elements", "tolerance"), [(16, 3e-6), (60, 1e-8)], ids=["dense", "sparse"])
def test_free_free_has_three_rigid_modes_and_the_exact_rest(elements, tolerance):
    beam = thick(bf.CRBF(4), elements)
    exact = np.sort(FREE + AXIAL_FREE)
    modes = bf.solve_modes(bf.Model([beam]), 3 + len(exact))
    assert modes.rigid == ("translates along x", "translates along y", "turns about (0.5, 0)")
    assert np.all(modes.frequencies[:3] == 0.0)
    assert modes.elastic == pytest.approx(exact, rel=tolerance)
    # a translation of mass one: 1 / sqrt(m) at every node
    assert modes.modes[0].reshape(-1, 3)[:, 0] == pytest.approx(1 / np.sqrt(78.0), rel=1e-9)


def test_order_of_convergence_is_twice_the_order_of_the_field():
    errors = []
    for elements in (4, 8, 16):
        beam = thick(bf.CRBF(2), elements)
        modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 1)
        errors.append(abs(modes.frequencies[0] / CLAMPED[0] - 1.0))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 3.6) & (orders < 4.4))


def test_hanging_pendulum_stands_under_its_own_weight():
    """The clamped beam hangs straight, so its state is an equilibrium of the pinned one too."""
    beam, weight = rubber((0, -1.2), 32), bf.Gravity((0, -9.81))
    hanging = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [weight]))
    modes = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start)], [weight]), 16, about=hanging)
    found = 2 * np.pi * modes.frequencies
    for exact in HANGING:
        assert np.abs(found / exact - 1.0).min() < 1e-9
    assert modes.rigid == ()
    weightless = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start)], [weight]), 2)
    assert weightless.rigid == ("turns about (0, 0)",)


@pytest.mark.parametrize("side", [-1.0, 1.0], ids=["hangs", "stands"])
def test_a_stiff_pendulum_swings_below_its_pin_and_falls_above(side):
    """omega^2 = m g L/2 / (m L^2/3 + rho I L): a frequency below, a growth above."""
    beam, weight = rubber((0, 1.2 * side), 4, youngs_modulus=1e11), bf.Gravity((0, -9.81))
    state = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [weight]))[-1]
    modes = bf.solve_modes(bf.Model([beam], [bf.Pin(beam.start)], [weight]), 2, about=state)
    rate = np.sqrt(9.81 * 0.6 / (1.2**2 / 3 + 8.533e-6 / 1.6e-3))
    found = modes.growth[0] if side > 0 else 2 * np.pi * modes.frequencies[0]
    assert found == pytest.approx(rate, rel=1e-5)
    assert modes.growth[0] * modes.frequencies[0] == 0.0
    assert modes.growth[1] == 0.0


def test_frequencies_and_shapes_are_those_of_the_full_matrices(element):
    beam = bf.Beam(bf.Line((0, 0), (1.0, 0.5)), 4, element, bf.Rectangle(0.1, 0.1), STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 1e5))])
    state = bf.solve_static(model)[-1]
    modes = bf.solve_modes(model, 5, about=state)
    system = System(model, static=True)
    rest = np.zeros_like(state.p)
    stiffness, mass = (
        linearise(system, state.p, rest, rest, 1.0, weights)[1].sparse(UNROTATED).toarray()
        for weights in (STATICS, INERTIA)
    )
    exact = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[:5]) / (2 * np.pi)
    assert modes.frequencies == pytest.approx(exact, rel=1e-7)
    shapes = modes.modes[:, system.free_dofs]
    assert shapes @ mass @ shapes.T == pytest.approx(np.eye(5), abs=1e-8)


@pytest.mark.parametrize("elements", [4, 60], ids=["dense", "sparse"])
def test_a_turned_model_has_the_same_modes(elements):
    c, s = np.cos(0.4), np.sin(0.4)
    found = []
    for end, normal in (((1.0, 0.0), (0.0, 1.0)), ((c, s), (-s, c))):
        beam = thick(bf.CRBF(4), elements, end=end)
        model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, normal)])
        modes = bf.solve_modes(model, 6)
        slide = modes.solution(0).displacement(beam.end)
        assert np.abs(slide @ normal).max() < 1e-12
        found.append(modes.frequencies)
    assert found[1] == pytest.approx(found[0], rel=1e-7)


@pytest.mark.parametrize(
    ("support", "words"),
    [
        (lambda b: [bf.Pin(b.start)], ("turns about (0, 0)",)),
        (lambda b: [bf.Roller(b.start)], ("translates along x", "turns about (0, 0.5)")),
        (lambda b: [bf.Roller(b.start, (1, 1))], ("translates along (0.707, -0.707)", "turns about (0.5, 0.5)")),
        (lambda b: [bf.Roller(b.start), bf.Roller(b.end, (1, 1))], ("turns about (0, 0)",)),
    ],
)
def test_rigid_motions_are_named(support, words):
    beam = thick(bf.CRBF(2), 6, end=(1.0, 1.0))
    modes = bf.solve_modes(bf.Model([beam], support(beam)), 5)
    assert modes.rigid == words
    assert np.all(modes.elastic > 100.0)


def test_equal_beams_have_every_mode_as_often_as_there_are_beams():
    """Multiple eigenvalues, which an iteration with one starting vector can miss."""
    beams = [thick(bf.CRBF(2), 40, (0, i), (1, i)) for i in range(3)]
    modes = bf.solve_modes(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams]), 12)
    exact = np.repeat([*CLAMPED[:2], AXIAL_CLAMPED[0], CLAMPED[2]], 3)
    assert modes.frequencies == pytest.approx(exact, rel=1e-5)
    free = bf.solve_modes(bf.Model(beams, [bf.Clamp(beams[0].start), bf.Clamp(beams[1].start)]), 4)
    assert len(free.rigid) == 3
    assert free.rigid[0].startswith("beam 0 stays, beam 1 stays, beam 2 ")


def test_a_compressed_column_diverges_beyond_its_critical_load():
    beam = thick(bf.CRBF(4), 6)
    load = 2e11 * beam.section.second_moment * 1.2 * 2.4567382724132
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-load, 0))])
    with pytest.warns(bf.UnstableWarning):
        states = bf.solve_static(model, steps=2)
    below = int(np.flatnonzero(states.load_factor < 0.8)[-1])
    stable = bf.solve_modes(model, 1, about=states[below])
    assert stable.growth[0] == 0.0
    assert stable.status is bf.Status.COMPLETED
    modes = bf.solve_modes(model, 2, about=states)
    assert modes.status is bf.Status.UNSTABLE
    assert modes.growth[0] > 0.0
    assert modes.frequencies[0] == 0.0
    assert modes.growth[1] == 0.0


class Dense:
    def __init__(self, matrix):
        self.matrix = matrix

    def solve(self, right):
        return np.linalg.solve(self.matrix, right)


def test_known_pairs_of_an_unsymmetric_matrix_are_left_out_and_leave_nothing_in_the_others(rng):
    """All pairs of a triangular K over a mass of 2, the first of them known: mu = 2 / K_ii."""
    stiffness = np.triu(rng.uniform(-1.0, 1.0, (6, 6)), 1) + np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    mass = 2.0 * np.eye(6)
    known = np.array([2.0]), np.eye(6)[:, :1] / np.sqrt(2.0)
    values, shapes = general_pairs(_csr(mass), Dense(stiffness), 5, known)
    assert values == pytest.approx(2.0 / np.arange(2.0, 7.0))
    assert stiffness @ shapes * values == pytest.approx(mass @ shapes)


def test_modes_under_a_follower_force_have_a_mass_of_one():
    beam = thick(bf.CRBF(4), 4)
    force = bf.PointForce(beam.end, (-0.1 * 2e11 * beam.section.second_moment, 0.0), follower=True)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [force])
    modes = bf.solve_modes(model, 3, about=bf.solve_static(model))
    system, rest = system_of(model, static=True), np.zeros(model.size)
    mass = linearise(system, modes.state.p, rest, rest, 1.0, INERTIA)[1].sparse(UNROTATED)
    shapes = modes.modes[:, system.free_dofs]
    assert np.abs(np.conj(shapes) @ (mass @ shapes.T)).diagonal() == pytest.approx(1.0, rel=1e-9)


def test_flutter_of_a_double_pendulum_begins_at_zieglers_load():
    """Masses 2 and 1, a follower force: flutter beyond 7/2 - sqrt(2); Ziegler 1952."""
    mass = np.array([[3.0, 1.0], [1.0, 1.0]])
    growths = []
    for load in 3.5 - np.sqrt(2.0) + np.array([-1e-3, 1e-3]):
        stiffness = np.array([[2.0 - load, load - 1.0], [-1.0, 1.0]])
        values, shapes = general_pairs(_csr(mass), Dense(stiffness), 2, nothing_known(2))
        assert stiffness @ shapes == pytest.approx(mass @ shapes / values)
        growths.append(_rates(1.0 / values).real)
    assert np.all(growths[0] == 0.0)
    assert np.sort(np.sign(growths[1])).tolist() == [-1.0, 1.0]


def _csr(matrix):
    from scipy.sparse import csr_array

    return csr_array(matrix)


def test_a_mode_is_a_solution_that_conserves_energy(tmp_path):
    beam = thick(bf.CRBF(4), 6)
    modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 2)
    moved = modes.solution(0, amplitude=1e-4, frames=9)
    assert moved.time[-1] == pytest.approx(1 / modes.frequencies[0])
    assert np.abs(moved.displacement(beam.end)[0, 1]) == pytest.approx(1e-4, rel=1e-12)
    assert moved.p[-1] == pytest.approx(moved.p[0], abs=1e-12)
    assert moved.energy().kinetic[2] == pytest.approx(moved.energy().strain[0], rel=1e-4)
    moved.plot(tmp_path / "mode.svg")
    moved.to_vtk(tmp_path / "mode.pvd")
    assert (tmp_path / "mode.pvd").exists()


def test_a_rigid_mode_moves_for_a_second():
    beam = thick(bf.CRBF(2), 4)
    moved = bf.solve_modes(bf.Model([beam]), 3).solution(1, amplitude=0.2)
    assert moved.displacement(beam.end)[-1] == pytest.approx([0.0, 0.2], abs=1e-9)
    assert moved.velocity(beam.end) == pytest.approx(np.tile([0.0, 0.2], (25, 1)), abs=1e-9)


def test_modes_are_the_same_in_every_run():
    beam = thick(bf.CRBF(2), 200)
    first, second = (bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 5) for _ in range(2))
    assert np.array_equal(first.frequencies, second.frequencies)
    assert np.array_equal(first.modes, second.modes)


def test_counts_below_a_value_are_those_of_the_reference():
    beam = thick(bf.CRBF(4), 20)
    system = System(bf.Model([beam]), static=True)
    pencil = Pencil(system, system.reference, 0.0)
    for expected, hertz in ((3, 1.0), (3, 502.7), (4, 502.8), (13, 7909.0)):
        assert pencil.below((2 * np.pi * hertz) ** 2) == expected


def unstable_pencil(element):
    """A hinged column that is shortened, but kept straight, so far that four modes grow."""
    beam = thick(element, 12)
    system = System(bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))]), static=True)
    straight = system.reference.copy()
    straight[system.model.meshes[0].kinematics.dof[:, 0]] *= 1.0 - 0.13
    return Pencil(system, straight, 1.0)


def test_the_shift_about_an_unstable_state_is_clear_of_its_growing_modes_and_found_by_few_counts(monkeypatch):
    """Eigenvalues by a dense solver; counting those that grow as near zero took 60 factorisations."""
    pencil = unstable_pencil(bf.CRBF(2))
    values = eigh(pencil.stiffness.toarray(), pencil.mass.toarray(), eigvals_only=True)
    assert (values < 0.0).sum() == 4
    counts, below = [], Pencil.below
    monkeypatch.setattr(Pencil, "below", lambda own, value: counts.append(value) or below(own, value))
    shift = pencil.shift(0)
    assert 4.0 * values[0] / 0.75 <= shift <= values[0] / 0.75
    assert len(counts) < 25
    for factor, clear in ((0.9, False), (1.1, False), (1.3, False), (1.4, True), (4.0, True)):
        assert (pencil.below(0.75 * factor * values[0]) == 0) == clear


def test_bad_input_is_named():
    beam = thick(bf.CRBF(1), 3)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 1e6))])
    solution = bf.solve_static(model)
    with pytest.raises(bf.InputError, match="count must be at least 1"):
        bf.solve_modes(model, 0)
    with pytest.raises(bf.InputError, match="only 9 unknown"):
        bf.solve_modes(model, 10)
    with pytest.raises(bf.InputError, match="not in equilibrium"):
        bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 1, about=solution)
    with pytest.raises(bf.InputError, match="about does not have the 5 nodes of CRBF-1 on beam 0"):
        bf.solve_modes(bf.Model([thick(bf.CRBF(1), 4)]), 1, about=solution)
    with pytest.raises(bf.InputError, match="about must be a state"):
        bf.solve_modes(model, 1, about=solution.p[-1])
    moving = bf.simulate(bf.Model([beam]), 0.1, 0.1, velocity=bf.RigidVelocity((1.0, 0.0)))
    with pytest.raises(bf.InputError, match="this solution is a motion"):
        bf.solve_modes(bf.Model([beam]), 1, about=moving)
    with pytest.raises(bf.InputError, match="moves"):
        bf.solve_modes(bf.Model([beam]), 1, about=moving[-1])
    with pytest.raises(bf.InputError, match="mode must be between 0 and 1"):
        bf.solve_modes(model, 2).solution(2)
    standing = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0, -9.81), scale=False)])
    with pytest.raises(bf.InputError, match="not in equilibrium"):
        bf.solve_modes(standing, 1)


def test_an_iteration_that_fails_on_too_many_unknowns_to_find_all_of_them_is_named():
    def fails(vectors):
        raise ArpackNoConvergence("no convergence", np.empty(0), np.empty((0, 0)))

    with pytest.raises(bf.ConvergenceError, match="the iteration for 3 eigenvalues of 5000 unknowns did not converge"):
        first_that_works(lambda: pytest.fail("all pairs of 5000 unknowns"), fails, 5000, 3)
    assert first_that_works(lambda: "all of them", fails, 4000, 3) == "all of them"


def test_what_round_off_leaves_of_a_free_turn_is_no_mode():
    """Two joined bars, E 1 : 2e5, on a soft spring about which they turn freely: else they vibrate as without it."""
    soft, stiff = (
        bf.Beam(bf.Line(start, end), 3, bf.BilinearCRBF(), section, material)
        for start, end, section, material in (
            ((0, 0), (0.44, 0), bf.Rectangle(0.042, 0.0087), bf.Material(1.3e5, 0.3, 12.0)),
            ((0.44, 0), (1.4, 0.3), bf.Rectangle(0.014, 0.019), bf.Material(2.9e10, 0.3, 31e3)),
        )
    )
    joints = [bf.Rigid(soft.end, stiff.start)]
    free = bf.solve_modes(bf.Model([soft, stiff], [], [], joints), 11).elastic
    held = bf.Model([soft, stiff], [bf.Spring(stiff.at(1.0 / 3.0), (0.03, 0.016))], [], joints)
    for count in range(4, 12):
        found = bf.solve_modes(held, count)
        assert len(found.rigid) == 1
        # the spring adds 0.01 Hz squared to the square of each
        assert found.elastic[2:] == pytest.approx(free[: count - 3], rel=2e-6)


def test_shapes_far_above_the_lowest_keep_their_digits():
    """A thin arc on a spring so soft that its elastic modes, 1e11 times as high squared, are those of a free one."""
    thin = bf.Section(area=9.4e-8, second_moment=3.3e-15)
    arc = bf.Beam(bf.Arc((0, 0), 0.75, 2.0, 1.2), 4, bf.ANCFCRBF(), thin, bf.Material(7.7e13, 0.3, 15.0))
    free = bf.solve_modes(bf.Model([arc]), 6)
    held = bf.solve_modes(bf.Model([arc], [bf.Spring(arc.at(0.5), (2e-4, 1e-4), 1e-4)]), 6)
    for shape, other in zip(free.modes[3:], held.modes[3:], strict=True):
        same = shape * np.sign(shape @ other)
        assert np.abs(same - other).max() <= 2e-8 * np.abs(shape).max()
