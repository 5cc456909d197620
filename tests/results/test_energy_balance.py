"""Energy of motions in every row against work and damping."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf
from beamfem.errors import EnergyWarning, TimeStepWarning
from beamfem.results.energy_balance import balance, removal, resolved
from beamfem.solve.motion.period_error import lengthened_period, period_error

ALUMINIUM, SECTION = bf.Material(7e10, 0.33, 2700.0), bf.Rectangle(0.01, 0.01)
STEEL = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)


def straight(material=STEEL, elements=4):
    return bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order=3), SECTION, material)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("step", [2.5e-4, 5e-4, 1e-3])
def test_a_cantilever_that_loses_its_joint_keeps_its_energy(order, step):
    """It once rose to the sevenfold, and 340-fold at order 3, and was below that of the start in the end."""
    halves = [bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 4, bf.CRBF(order=order), SECTION, ALUMINIUM) for x in (0.0, 0.5)]
    clamp, push = [bf.Clamp(halves[0].start)], [bf.PointForce(halves[1].end, (0, 20.0))]
    joined = bf.Model(halves, clamp, push, joints=[bf.Rigid(halves[0].end, halves[1].start)])
    motion = bf.simulate(bf.Model(halves, clamp), 0.5, step, start=bf.solve_static(joined)[-1])
    energy = motion.energy().total
    assert energy.max() < 1.002 * energy[0]
    assert not any("energy" in warning for warning in motion.warnings)


@pytest.mark.parametrize("pressed", [False, True])
def test_energy_that_rises_between_start_and_end_is_warned_of(pressed, uncut_steps):
    """It is judged in every row; a faint pressure once hid it."""
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.ANCF(forces=bf.ElasticLine()), SECTION, STEEL)
    loads = [bf.Temperature(bar, 100.0), *([bf.Pressure(bar, 1e-9)] if pressed else [])]
    with pytest.warns(EnergyWarning, match="rises by"):
        motion = bf.simulate(bf.Model([bar], [bf.Clamp(bar.start)], loads), 0.1, 1e-3)
    energy = motion.energy().total
    assert energy[-1] < energy[0] < 0.01 * energy.max()


def test_a_stiff_bar_that_spins_too_fast_for_its_steps_is_warned_of(uncut_steps):
    """Its energy is (m L^3 / 3 + rotary inertia L) w^2 / 2 = 16.7 J."""
    section = bf.Section.from_stiffness(axial=1e7, shear=4e6, bending=1e3, mass=1.0, rotary_inertia=1e-4)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), section)
    spin = bf.RigidVelocity((0, 0), angular=10.0, about=(0, 0))
    with pytest.warns(EnergyWarning, match="rises by"):
        motion = bf.simulate(bf.Model([bar], [bf.Pin(bar.start)]), 1.6, np.pi / 250, velocity=spin)
    assert motion.energy().total[0] == pytest.approx((1.0 / 3.0 + 1e-4) * 50.0, rel=1e-12)


def test_a_heated_bar_in_which_nothing_moves_is_not_warned_of():
    bar = straight(elements=8)
    held = bf.Model([bar], [bf.Clamp(bar.start), bf.Clamp(bar.end)], [bf.Temperature(bar, 50.0)])
    motion = bf.simulate(held, 0.05, 1e-3)
    assert motion.energy().total == pytest.approx(0.5 * 2e7 * (1.2e-5 * 50.0) ** 2, rel=1e-9)
    assert not motion.warnings


def smooth(t):
    """Rise to 1 in 0.2 s."""
    return 0.5 * (1.0 - np.cos(np.pi * min(t / 0.2, 1.0)))


DRIVEN = {
    "dead": lambda bar: ([bf.Clamp(bar.start)], [bf.PointForce(bar.end, (0.0, 20.0), amplitude=smooth)]),
    "follower": lambda bar: (
        [bf.Clamp(bar.start)],
        [bf.PointForce(bar.end, (0.0, 20.0), amplitude=smooth, follower=True)],
    ),
    "pressure": lambda bar: ([bf.Clamp(bar.start)], [bf.Pressure(bar, 50.0, amplitude=smooth)]),
    "heated": lambda bar: ([bf.Clamp(bar.start)], [bf.Temperature(bar, 0.0, gradient=5e4, amplitude=smooth)]),
    "moved": lambda bar: (
        [bf.Prescribed(bar.start, ux=0.0, uy=lambda t: 0.1 * smooth(t), rotation=0.0)],
        [],
    ),
}


@pytest.mark.parametrize("kind", DRIVEN)
@pytest.mark.parametrize("retardation", [0.0, 2e-3])
def test_work_and_damping_explain_the_energy_of_driven_motions(kind, retardation):
    """Resolved steps without numerical damping leave no difference but the error of the steps and of quadrature."""
    bar = straight(bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5, retardation_time=retardation))
    supports, loads = DRIVEN[kind](bar)
    motion = bf.simulate(bf.Model([bar], supports, loads), 0.4, 1e-3, bf.GeneralizedAlpha(1.0))
    found = balance(motion)
    assert found.exchanged > 0.1
    assert np.abs(found.loss).max() < 5e-3 * found.exchanged
    assert not motion.warnings
    assert np.abs(found.doubt).max() < 0.1 * found.exchanged  # else no rise of a tenth would be seen


@pytest.mark.parametrize(
    "rows",
    [{"step": 5e-3}, {"step": 4e-3}, {"tolerance": 1e-4}, {"step": 0.05, "tolerance": 1e-6},
     {"step": 1e-3, "save_every": 50}, {"step": 1e-3, "save_every": 70}],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["dead", "follower", "motor"])
def test_loads_that_jump_do_the_work_that_the_motion_gains(kind, rows):
    """At jumps it once was that of the mean of the load: up to 25 mJ less, and more where they lie between rows."""
    times = bf.Piecewise(lambda t: 1.0 if t < 0.25 else -0.5 if t < 0.6 else 2.0, kinks=[0.25, 0.6])
    section = bf.Section.from_stiffness(axial=1e6, shear=1e6, bending=1e4, mass=1.0, rotary_inertia=1e-3)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(order=2), section)
    load = {
        "dead": bf.DistributedLoad(bar, (3.0, 0.0), amplitude=times),
        "follower": bf.PointForce(bar.end, (0.0, 1.0), amplitude=times, follower=True),
        "motor": bf.Motor(bar.start, torque=times),
    }[kind]
    motion = bf.simulate(bf.Model([bar], [] if kind == "dead" else [bf.Pin(bar.start)], [load]), 1.0, **rows)
    energy = motion.energy()
    between = not np.isclose(motion.at, 0.25).any()  # the path up to the jump is that of a line from row to row
    assert energy.error == pytest.approx(0.0, abs=0.01 if between else 1e-9 if kind == "dead" else 2e-3)
    assert energy.work[-1] == pytest.approx(energy.total[-1], rel=0.01)


def test_energy_that_numerical_damping_removes_is_warned_of():
    """A pulse of 0.06 s leaves a vibration of 8.2 Hz, which nothing damps."""
    bar = straight()
    force = bf.PointForce(bar.end, (0.0, 5.0), amplitude=lambda t: np.sin(np.pi * min(t / 0.06, 1.0)))
    model = bf.Model([bar], [bf.Clamp(bar.start)], [force])
    with pytest.warns(EnergyWarning, match="falls by"):
        bf.simulate(model, 4.0, 5e-3, bf.GeneralizedAlpha(0.0))
    assert not bf.simulate(model, 1.0, 2e-3).warnings


@pytest.mark.parametrize("how", ["events", "save_at", "file"])
def test_motions_with_events_rows_at_times_and_files_have_the_same_warnings(how, tmp_path):
    """They were silent about energy that is removed, and about resonances that their steps detune."""
    bar, duration = straight(), 4.0
    pulse = bf.PointForce(bar.end, (0.0, 5.0), amplitude=lambda t: np.sin(np.pi * min(t / 0.06, 1.0)))
    omega = 2.0 * np.pi * bf.solve_modes(bf.Model([bar], [bf.Clamp(bar.start)]), 1).frequencies[0]
    tuned = bf.PointForce(bar.end, (0.0, 0.1), amplitude=lambda t: np.sin(omega * t))
    given = {
        "events": [bf.Event("never", lambda state: 1.0)],
        "save_at": np.linspace(0.0, duration, 700),
        "file": tmp_path / "motion.h5",
    }
    for load, rho_inf, category in ((pulse, 0.0, EnergyWarning), (tuned, 0.9, TimeStepWarning)):
        model = bf.Model([bar], [bf.Clamp(bar.start)], [load])
        with pytest.warns(category) as issued:
            motion = bf.simulate(model, duration, 5e-3, bf.GeneralizedAlpha(rho_inf), **{how: given[how]})
        assert {str(each.message) for each in issued} == set(motion.warnings)
        if how == "file":
            assert bf.load(given["file"]).statistics == motion.statistics


@pytest.mark.parametrize("every", [1, 4])
def test_energies_are_not_evaluated_where_steps_resolve_a_motion(every):
    bar = straight()
    sagging = bf.Model([bar], [bf.Clamp(bar.start)], [bf.Gravity((0.0, -9.81))])  # 8.2 Hz
    assert resolved(bf.simulate(sagging, 0.5, 5e-3, save_every=every))
    assert not resolved(bf.simulate(sagging, 5.0, 5e-2, save_every=every))


def test_rows_that_do_not_resolve_the_work_of_a_support_give_no_alarm():
    """Reactions alternate from step to step; every second row has those of one side only."""
    bar = straight()
    shaken = bf.Prescribed(bar.start, ux=0.0, uy=lambda t: 0.05 * np.sin(30.0 * t), rotation=0.0)
    model = bf.Model([bar], [shaken])
    assert not bf.simulate(model, 0.2, 1e-3).warnings
    assert not bf.simulate(model, 0.2, 1e-3, save_every=2).warnings


@pytest.mark.parametrize(
    "rule",
    [
        bf.GeneralizedAlpha(0.0).rule(0.1),
        bf.GeneralizedAlpha(0.9).rule(0.1),
        np.array([0.1, 0.0, 0.2, 0.7, 0.36]),  # HHT-alpha
        np.array([0.1, 0.0, 0.0, 0.6, 0.3025]),  # Newmark, of first order
    ],
)
def test_schemes_remove_the_energy_that_the_moduli_of_their_roots_tell(rule):
    _, alpha_m, alpha_f, gamma, beta = rule
    turn = 0.02
    after = [[1.0, 0.0, -beta], [0.0, 1.0, -gamma], [(1.0 - alpha_f) * turn**2, 0.0, 1.0 - alpha_m]]
    before = [[1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1.0 - gamma], [-alpha_f * turn**2, 0.0, -alpha_m]]
    roots = np.linalg.eigvals(np.linalg.solve(after, before))
    second, fourth = removal(rule)
    removed = -2.0 * np.log(np.abs(roots[roots.imag > 0.0]))
    # the next term of the series is some 4 (w h)^2 of the last one
    assert second * turn**2 + fourth * turn**4 == pytest.approx(removed[0], rel=2e-3)


@pytest.mark.parametrize("steps", [10, 20, 60])
def test_the_period_error_of_the_trapezoidal_rule_is_that_of_its_closed_form(steps):
    """A step turns by 2 atan(w h / 2)."""
    turn = 2.0 * np.pi / steps
    expected = turn / (2.0 * np.arctan(0.5 * turn)) - 1.0
    assert period_error(bf.GeneralizedAlpha(1.0).rule(0.1), 10.0 / steps) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("steps", "periods"), [(20, 80), (20, 200), (60, 80)])
def test_a_resonance_that_its_steps_detune_is_warned_of(steps, periods):
    """1.566 X / (2 zeta) = 1.53 mm at the tip of a post whose base vibrates by X (Blevins); half of it at 20 steps."""
    frequency, ratio, size = 8.179247, 0.0051, 1e-5
    omega = 2.0 * np.pi * frequency
    post = straight(bf.Material(2e11, 0.3, 7800.0, retardation_time=2.0 * ratio / omega))
    shaken = bf.Prescribed(post.start, ux=0.0, uy=lambda t: size * np.sin(omega * t), rotation=0.0)
    run = lambda: bf.simulate(bf.Model([post], [shaken]), periods / frequency, 1.0 / frequency / steps)  # noqa: E731
    if steps == 20:
        with pytest.warns(TimeStepWarning, match="detune the resonance"):
            motion = run()
        assert "time step" in motion._repr_html_()
        assert any("detune" in sentence for sentence in motion.warnings)
    else:
        motion = run()
        assert not motion.warnings
        built_up = 1.566 * size / (2.0 * ratio) * (1.0 - np.exp(-2.0 * np.pi * ratio * periods))
        assert np.abs(motion.displacement(post.end)[-120:, 1]).max() == pytest.approx(built_up, rel=0.05)
    assert lengthened_period(motion)[0] == pytest.approx(frequency, rel=0.02)


@pytest.mark.parametrize("tuned", [1.0, 1.6])
@pytest.mark.parametrize("parts", ["weight", "cable", "weight and cable"])
def test_a_detuned_resonance_is_warned_of_beside_weight_and_cables(parts, tuned):
    """The strain energy of dead loads and pretension is not that of the vibration."""
    post = straight(bf.Material(2e11, 0.3, 7800.0, retardation_time=4e-4))
    supports, weight = [bf.Clamp(post.start)], [bf.Gravity((0.0, -9.81))] if "weight" in parts else []
    stays = [bf.Cable(post.at(0.5), (0.0, 1.0), 2e3, pretension=20.0)] if "cable" in parts else []
    still = bf.Model([post], supports, weight, connectors=stays)
    start = bf.solve_static(still)
    frequency = bf.solve_modes(still, 1, about=start).frequencies[0]
    drive = bf.PointForce(post.end, (0.0, 0.02), amplitude=lambda t: 1.0 + np.sin(2.0 * np.pi * tuned * frequency * t))
    model = still.with_loads([*weight, drive])
    run = lambda: bf.simulate(model, 60.0 / frequency, 0.05 / frequency, start=start)  # noqa: E731
    if tuned == 1.0:
        with pytest.warns(TimeStepWarning, match="detune the resonance"):
            run()
    else:
        assert not run().warnings


@pytest.mark.parametrize(("steps", "periods", "tuned"), [(10, 60, 1.0), (20, 20, 1.0), (80, 20, 1.0), (10, 20, 1.5)])
def test_a_resonance_without_damping_that_its_steps_detune_is_warned_of(steps, periods, tuned):
    """The tip grows by pi x_st 0.9707 a period (the share of the first mode); 10 steps left 15 % of it, silently."""
    post, size = straight(bf.Material(2e11, 0.3, 7800.0)), 0.1
    frequency = bf.solve_modes(bf.Model([post], [bf.Clamp(post.start)]), 1).frequencies[0]
    omega = 2.0 * np.pi * frequency
    tip = bf.PointForce(post.end, (0.0, size), amplitude=lambda t: np.sin(tuned * omega * t))
    model = bf.Model([post], [bf.Clamp(post.start)], [tip])
    slope = (
        np.pi
        * 0.9707
        * bf.solve_static(replace(model, loads=[replace(tip, amplitude=None)])).displacement(post.end)[-1, 1]
    )
    run = lambda: bf.simulate(model, periods / frequency, 1.0 / frequency / steps)  # noqa: E731
    if tuned != 1.0:
        assert not run().warnings
    elif steps == 80:
        motion = run()
        assert not motion.warnings
        # a step h slows the growth by (w h)^2 / 3 = 0.2 %
        assert np.abs(motion.displacement(post.end)[:, 1]).max() == pytest.approx(slope * periods, rel=3e-3)
    else:
        with pytest.warns(TimeStepWarning, match="has no damping: they detune the resonance"):
            motion = run()
        assert np.abs(motion.displacement(post.end)[:, 1]).max() < 0.92 * slope * periods
