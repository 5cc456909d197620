"""Motions end where the physics goes on: steps that fail, or change the energy, are redone with shorter ones."""

from itertools import product

import numpy as np
import pytest
from refused_steps import (
    CASES,
    ELEMENTS,
    UNDAMPED,
    all_steps,
    double_pendulum,
    largest_changes,
    linked_arms,
    slider_crank,
    strip,
    with_states,
)

import beamfem as bf
from studies.benchmarks.random_motions import case, changes

QUICK = {
    ("double pendulum, 5 ms", "ShearRigid"),
    ("double pendulum, 2 ms", "CRBF2"),
    ("strip, 5 ms", "CRBF1"),
    ("strip, 5 ms", "ANCF"),
    ("strip, 1 ms", "CRBF2"),
    ("tapered rod", "CRBF3"),
    ("four-bar linkage", "CRBF3"),
    ("joint removed", "ShearRigid"),
    ("joint made a hinge", "CRBF2"),
    ("slider-crank", "ShearRigid"),
    ("flying beam", "ANCF-CRBF"),
}


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        pytest.param(*case, marks=() if case in QUICK else pytest.mark.slow, id=f"{case[0]}, {case[1]}")
        for case in product(CASES, ELEMENTS)
    ],
)
def test_the_motion_goes_on_to_its_end(name, kind):
    motion_of, step, integrator = CASES[name]
    options = motion_of(ELEMENTS[kind])
    with all_steps() as states:
        motion = bf.simulate(step=step, integrator=integrator, **options)
    assert motion.time == pytest.approx(step * np.arange(round(options["duration"] / step) + 1))
    statistics = motion.statistics
    assert statistics.rejected == statistics.cuts
    assert statistics.steps >= len(motion) - 1 + 3 * statistics.cuts  # a cut divides one step at least
    if name == "slider-crank":
        of_all = with_states(motion, states).energy()
        assert motion.energy().work[-1] == pytest.approx(of_all.work[-1], rel=1e-9)
    after_the_pulse = motion[2:] if name == "flying beam" else motion
    rise, fall = largest_changes(after_the_pulse)
    assert rise < 0.02
    if integrator is UNDAMPED:
        assert fall < 0.02


@pytest.mark.filterwarnings("ignore::beamfem.errors.LargeStrainWarning")
@pytest.mark.parametrize(
    ("kind", "elements", "duration"),
    [
        ("CRBF1", 1, 2.5),
        *(pytest.param(kind, 4, 20.0, marks=pytest.mark.slow) for kind in ELEMENTS),
    ],
)
def test_linked_arms_go_on_without_numerical_damping(kind, elements, duration):
    """Rates that do not satisfy the conditions of links alternate, and are put onto them before steps are cut.

    Gradients of so soft a beam turn inside out at the free ends, which is no error unless a step jumps there.
    """
    motion = bf.simulate(linked_arms(ELEMENTS[kind], elements=elements), duration, 0.01, UNDAMPED)
    assert motion.statistics.cuts > 0
    assert max(largest_changes(motion)) < 0.02


@pytest.mark.filterwarnings("ignore:the energy falls:beamfem.EnergyWarning")  # with rho_inf = 0.9
@pytest.mark.parametrize("seed", [4, 45, 55, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(30, 90))])
def test_random_motions_keep_their_energy(seed):
    """Also those whose first steps fail, of which too few precede the failure to show how fast the motion varies."""
    found = case(seed)
    motion, rise, fall = changes(found)
    assert motion.status is bf.Status.COMPLETED
    assert rise < 0.02
    assert fall < 0.02 or found.rho_inf < 1.0


def test_rows_of_cut_steps_do_not_depend_on_which_are_kept():
    options = {"step": 5e-3, "integrator": UNDAMPED, **strip(bf.CRBF(1))}
    every, some = bf.simulate(**options), bf.simulate(**options, save_every=7)
    assert every.statistics.cuts > 0
    assert np.array_equal(some.time, every.time[[*range(0, 201, 7), 200]])
    assert np.array_equal(some.p, every.p[[*range(0, 201, 7), 200]])
    assert np.array_equal(some.turned, every.turned[[*range(0, 201, 7), 200]])


def test_short_steps_are_needed_only_where_steps_fail():
    """Until its first step that fails, a double pendulum moves as with steps that are not cut."""
    options = {"step": 5e-3, "integrator": UNDAMPED, **double_pendulum(bf.ShearRigid())}
    motion = bf.simulate(**options)
    short = bf.simulate(**(options | {"duration": 0.4}))
    assert short.statistics.cuts == 0
    assert np.array_equal(motion.p[:81], short.p)
    assert motion.statistics.steps < 3 * (len(motion) - 1)


def test_a_step_of_ones_own_that_fails_is_cut():
    class Impatient:
        """Backward Euler steps, but none longer than a hundredth of a second."""

        def step(self, motion, begin, end):
            h = end - begin.at
            if h > 0.011:
                raise bf.ConvergenceError("too long", None)
            p, v = begin.p.copy(), begin.v.copy()
            state = [p, v, np.zeros_like(v)]

            def linearise():
                return motion.residual(*state, end), [[motion.tangent(*state, end, (1.0, 1.0 / h, 1.0 / h**2))]]

            def move(change):
                state[0][motion.free] += change[0]
                state[1][:] = (state[0] - begin.p) / h
                state[2][:] = (state[1] - begin.v) / h
                return change

            state[1][:], state[2][:] = 0.0, -begin.v / h
            motion.iterate(linearise, move)
            return bf.State(*state, end, begin.model)

    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(1e9, 0.3, 1000.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))])
    motion, fine = (bf.simulate(model, 0.16, step, Impatient()) for step in (0.04, 0.01))
    assert motion.statistics.cuts == 4
    assert motion.statistics.steps == 16
    np.testing.assert_allclose(motion.p, fine.p[::4], atol=1e-12)


def test_dampers_explain_no_rise_of_energy():
    """A damper only takes energy, whatever its force at the rows is; its spring is part of the energy."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0))
    other = bf.Beam(bf.Line((0, 0.1), (1, 0.1)), 4, bf.CRBF(2), beam.section, beam.material)
    links = [bf.SpringDamper(beam.end, other.end, 50.0, 5.0)]
    model = bf.Model([beam, other], [bf.Clamp(beam.start), bf.Clamp(other.start)], [bf.PointForce(beam.end, (0, -1.0))],
                     connectors=links)  # fmt: skip
    motion = bf.simulate(model, 0.5, 1e-3, UNDAMPED)
    rise, loss = largest_changes(motion)
    assert rise < 1e-2
    assert loss < 1e-2
    assert motion.energy().total[-1] < -0.01 * np.ptp(motion.energy().potential)


@pytest.mark.parametrize("stored", [False, True])
def test_a_motion_that_bends_elements_too_far_ends_with_the_beam_that_needs_more(tmp_path, stored):
    """The end of a falling strand whips; three elements cannot be bent by more than a turn each.

    The state where it ends is named, also if the last row is long before.
    """
    rubber = bf.Material(1e6, 0.3, 3000.0)
    strand = bf.Beam(bf.Line((0, 0), (1.2, 0)), 3, bf.CRBF(3), bf.Rectangle(0.02, 0.003), rubber)
    model = bf.Model([strand], [bf.Pin(strand.start)], [bf.Gravity((0, -9.81))])
    with pytest.raises(bf.ConvergenceError, match=r"element of beam 0 is bent by .* rad there: use more elements"):
        bf.simulate(model, 3.0, 0.049, file=tmp_path / "strand.h5" if stored else None)
    with pytest.raises(bf.ConvergenceError, match=r"steps of .* s from .* s on; an element of beam 0 is bent"):
        bf.simulate(model, 3.0, 1.5)


def test_work_of_divided_steps_is_kept_with_all_that_keeps_rows(tmp_path):
    options = slider_crank(ELEMENTS["ANCF-CRBF"]) | {"duration": 0.15, "step": 2e-3, "integrator": UNDAMPED}
    motion, file = bf.simulate(**options), tmp_path / "motion.h5"
    exchanged = motion.energy().kinetic.max()
    assert np.ptp(motion.exchanged[:, 0]) > 0.1 * exchanged
    assert abs(motion.energy().error).max() < 0.02 * exchanged
    motion.save(file)
    some = bf.simulate(**options, save_every=5)
    at_some = bf.simulate(**options, save_at=motion.time[::5])
    for other, rows in (
        (bf.load(file), slice(None)),
        (motion[::5], slice(None, None, 5)),
        (some, slice(None, None, 5)),
        (at_some, slice(None, None, 5)),
    ):
        np.testing.assert_array_equal(other.exchanged, motion.exchanged[rows])
    in_file = bf.simulate(**options, file=tmp_path / "running.h5")
    assert abs(in_file.energy().error).max() < 0.02 * exchanged
    np.testing.assert_array_equal(bf.load(tmp_path / "running.h5").exchanged, in_file.exchanged)


@pytest.mark.parametrize("integrator", [None, UNDAMPED, bf.GeneralizedAlpha()], ids=["default", "undamped", "damped"])
def test_the_balance_of_a_motion_within_a_tolerance_is_that_of_its_rows(integrator):
    crank = slider_crank(ELEMENTS["ANCF-CRBF"])["model"]
    motion = bf.simulate(crank, 0.05, tolerance=1e-4, integrator=integrator)
    energy = motion.energy()
    assert abs(energy.error).max() < 0.02 * energy.kinetic.max()


def test_a_driven_motion_whose_steps_were_divided_warns_of_the_energy_that_they_remove():
    with pytest.warns(bf.EnergyWarning, match="the energy falls by"):
        motion = bf.simulate(step=2e-3, integrator=bf.GeneralizedAlpha(0.0), **slider_crank(ELEMENTS["CRBF2"]))
    assert motion.statistics.cuts > 0
