"""Supports that move: impulse and work for any continuous motion, order for smooth ones, closed forms."""

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
RUBBER = bf.Material(5e6, 0.3, 1000.0)


def post(material, motion, width=0.02, length=0.3, elements=8, order=2, loads=()):
    """An upright post whose clamped foot moves along x."""
    one = bf.Beam(bf.Line((0, 0), (0, length)), elements, bf.CRBF(order), bf.Rectangle(width, width), material)
    return one, bf.Model([one], [bf.Prescribed(one.start, ux=motion, uy=0.0, rotation=0.0)], loads)


def foot_acceleration(solution, beam):
    mesh = solution.model.mesh_of(beam.start)
    return solution.a[:, mesh.coordinates_of(0)["r^x"]]


def impulse(solution, beam):
    """Trapezoidal sum over time of the horizontal reaction at the foot."""
    force = solution.reaction(beam.start)[:, 0]
    return np.append(0.0, np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(solution.time)))


def shake(time):
    return 0.01 * (1.0 - np.cos(6.0 * np.pi * time))


TABLE = np.arange(0.0, 1.101, 1e-3)


@pytest.mark.parametrize("step", [1e-3, 2.5e-4])
def test_a_rubber_post_shaken_by_a_table_moves_as_with_the_smooth_function(step):
    one, model = post(RUBBER, lambda t: np.interp(t, TABLE, shake(TABLE)))
    table = bf.simulate(model, 0.5, step)
    smooth = bf.simulate(post(RUBBER, shake)[1], 0.5, step)
    tip = smooth.model.beams[0].end
    assert np.abs(table.displacement(one.end) - smooth.displacement(tip)).max() < 1e-5
    mean = foot_acceleration(table, one)
    if step == 1e-3:
        assert np.abs(mean).max() == pytest.approx(0.01 * (6.0 * np.pi) ** 2, rel=1e-3)
    # in finer steps each corner of the table shows, as its jump of velocity over one step
    corners = np.diff(shake(TABLE[:501]), 2) / 1e-3 / step
    assert np.abs(mean).max() == pytest.approx(np.abs(corners).max(), rel=1e-2)


@pytest.mark.parametrize(("corner", "step"), [(0.05, 1e-3), (0.0505, 1e-3), (0.0003, 1e-3), (0.05, 5e-4)])
def test_one_corner_gives_the_impulse_that_is_gained(corner, step):
    """0.068 N s for 0.021 N s when it was found, or nothing, as the corner met a step or not."""
    one, model = post(STEEL, lambda t: 0.1 * max(t - corner, 0.0))
    solution = bf.simulate(model, 0.2, step, bf.GeneralizedAlpha(1.0))
    gained = solution.linear_momentum()[:, 0]
    settled = solution.time > corner + 2e-3
    assert np.abs(impulse(solution, one) - gained)[settled].max() < 1e-7 * gained.max()  # what iterations leave
    mass = 7800.0 * 0.02**2 * 0.3
    assert gained[settled].mean() == pytest.approx(0.1 * mass, rel=0.02)


def test_a_damped_step_gives_the_same_impulse_once_the_post_is_at_rest(uncut_steps):
    # rows do not show all reactions of steps that are cut
    one, model = post(STEEL, lambda t: np.interp(t, [0.0103, 0.0251, 0.0337], [0.0, 1e-3, 4e-3]), width=0.1)
    solution = bf.simulate(model, 0.3, 1e-3, bf.GeneralizedAlpha(0.0))
    assert abs(impulse(solution, one)[-1]) < 1e-7 * np.abs(impulse(solution, one)).max()
    assert np.abs(solution.a[-1]).max() < 1e-9 * np.abs(solution.a).max()


@pytest.mark.parametrize("step", [1e-3, 7e-4])
def test_a_support_with_corners_does_the_work_that_the_beam_has_gained(step):
    """The trapezoidal work over displacements is exact for a rigid body at any corner."""
    course = [0.0, 0.0103, 0.0251, 0.0337], [0.0, 0.0, 1e-3, 4e-3]
    one, model = post(STEEL, lambda t: np.interp(t, *course), width=0.1, elements=2)
    solution = bf.simulate(model, 0.03, step, bf.GeneralizedAlpha(1.0))
    force, x = solution.reaction(one.start)[:, 0], solution.displacement(one.start)[:, 0]
    work = np.append(0.0, np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(x)))
    energy = solution.energy().total
    assert work[-1] == pytest.approx(energy[-1], rel=0.01)


def clamped_modes(count):
    """beta L and sigma of a clamped-free Euler beam."""
    roots = [1.8751040687119611, 4.6940911329741746, 7.854757438237613, 10.995540734875467]
    roots += [(k - 0.5) * np.pi for k in range(5, count + 1)]
    beta = np.array(roots[:count])
    return beta, (np.sinh(beta) - np.sin(beta)) / (np.cosh(beta) + np.cos(beta))


def test_a_post_on_a_kinked_base_follows_duhamel():
    """Modal superposition: each corner of the base adds -Gamma dv sin(omega t) / omega to each mode."""
    length, width, size = 1.0, 0.002, 1e-4
    corners = np.array([0.0, 0.2515, 0.4555, 0.851])
    values = size * np.array([0.0, 0.0, 1.0, -0.4, -0.4])
    times = np.append(corners, 1.25)
    beta, sigma = clamped_modes(6)
    rate = (beta / length) ** 2 * np.sqrt(2e11 * width**2 / (12.0 * 7800.0))
    step = 2.0 * np.pi / rate[0] / 2000.0
    one, model = post(STEEL, lambda t: np.interp(t, times, values), width, length, order=3)
    solution = bf.simulate(model, 1.2, step)
    expected = np.interp(solution.time, times, values)
    slopes = np.append(0.0, np.diff(values) / np.diff(times))
    at_tip = 2.0 * (-1.0) ** np.arange(6)
    for mode in range(6):
        for corner, jump in zip(corners, np.diff(slopes), strict=True):
            after = np.maximum(solution.time - corner, 0.0)
            swing = 2.0 * sigma[mode] / beta[mode] * jump * np.sin(rate[mode] * after) / rate[mode]
            expected = expected - at_tip[mode] * swing
    found = solution.displacement(one.end)[:, 0]
    assert np.abs(found - expected).max() < 0.01 * np.abs(expected).max()


@pytest.mark.parametrize("step", [5e-3, 2.5e-3, 1e-2])
def test_base_shear_of_a_steel_post_under_a_record_is_that_of_its_mass(step):
    """A record every 5 ms as a table; 1120 N if the base follows each corner exactly in steps of 2.5 ms."""
    record = np.arange(0.0, 1.02, 5e-3)
    ground = 0.016 * np.sin(2.0 * np.pi * record) ** 5
    one, model = post(STEEL, lambda t: np.interp(t, record, ground), 0.05, 1.0)
    solution = bf.simulate(model, 1.0, step)
    beta, _ = clamped_modes(1)
    rate = beta[0] ** 2 * np.sqrt(2e11 * 0.05**2 / (12.0 * 7800.0))
    w, t = 2.0 * np.pi, solution.time
    assert rate > 8.0 * 5.0 * w  # so that the post moves as a rigid body
    sine, cosine = np.sin(w * t), np.cos(w * t)
    exact = 7800.0 * 0.05**2 * 0.016 * w**2 * (20.0 * sine**3 * cosine**2 - 5.0 * sine**5)
    assert np.abs(solution.reaction(one.start)[:, 0] - exact).max() < 0.15 * np.abs(exact).max()


def test_a_corner_is_rounded_by_less_than_a_tenth_of_a_step():
    _, model = post(STEEL, lambda t: 0.1 * max(t - 0.0203, 0.0))
    solution = bf.simulate(model, 0.05, 1e-3)
    moved = solution.displacement(model.beams[0].start)[:, 0]
    wrong = np.abs(moved - 0.1 * np.maximum(solution.time - 0.0203, 0.0))
    assert wrong.max() < 0.08 * 0.1 * 1e-3
    assert wrong[np.abs(solution.time - 0.0203) > 5e-3].max() < 1e-14


def test_accelerations_of_smooth_motions_are_of_second_order_from_the_first_row_to_the_last():
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        one, model = post(RUBBER, lambda t: 0.01 * (np.sin(9.0 * t + 0.3) - np.sin(0.3)), elements=1)
        solution = bf.simulate(model, 0.2, step)
        wrong = foot_acceleration(solution, one) + 0.81 * np.sin(9.0 * solution.time + 0.3)
        errors.append([np.abs(wrong).max(), abs(wrong[0]), abs(wrong[-1])])
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all((orders > 1.9) & (orders < 2.1)), orders


def test_reactions_under_a_smooth_motion_are_of_second_order():
    rows = []
    for step in (4e-3, 2e-3, 1e-3, 5e-4):
        one, model = post(RUBBER, lambda t: 0.01 * np.sin(9.0 * t) ** 5, elements=2)
        solution = bf.simulate(model, 0.2, step)
        rows.append(solution.reaction(one.start)[:: round(4e-3 / step), 0])
    changes = np.abs(np.diff(rows, axis=0)).max(axis=1)
    orders = np.log2(changes[:-1] / changes[1:])
    assert np.all((orders > 1.8) & (orders < 2.3)), orders


def test_a_rigid_body_needs_its_mass_times_the_acceleration():
    """Found by mutation: halved accelerations of prescribed coordinates went unnoticed."""
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL)
    hold = [bf.Prescribed(p, ux=lambda t: 0.5 * 3.0 * t**2, uy=0.0, rotation=0.0) for p in (one.start, one.end)]
    solution = bf.simulate(bf.Model([one], hold), 0.02, 1e-3)
    force = solution.reaction(one.start)[:, 0] + solution.reaction(one.end)[:, 0]
    assert force == pytest.approx(np.full(21, 78.0 * 3.0), rel=1e-9)


def swinging(t):
    """A smooth course of 1, its rate and its acceleration."""
    s, c = np.sin(20.0 * t), np.cos(20.0 * t)
    return s**8, 160.0 * s**7 * c, 3200.0 * (7.0 * s**6 * c**2 - s**8)


STAGES = [bf.Midpoint(), bf.Gauss(2), bf.Gauss(3), bf.Radau(2), bf.Radau(3)]


@pytest.mark.parametrize("method", STAGES, ids=repr)
def test_a_steel_bar_on_a_support_needs_its_mass_times_the_acceleration(method):
    """Nodes beside the support ended their steps beside it: reactions were up to 110 times too large."""
    bar = bf.Beam(bf.Line((0, 0), (0.2, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.02), STEEL)
    shaken = bf.Prescribed(
        bar.start, ux=lambda t: 0.01 * swinging(t)[0], uy=lambda t: 0.01 * swinging(t)[0], rotation=0
    )
    motion = bf.simulate(bf.Model([bar], [shaken]), 0.3, 1e-3, method)
    mass, (_, rate, acceleration) = 7800.0 * 4e-4 * 0.2, swinging(motion.time)
    force, energy = 0.01 * mass * acceleration, 1e-4 * mass * rate**2
    off = np.abs(motion.reaction(bar.start)[:, :2] - force[:, None]).max()
    assert off < 3e-3 * np.abs(force).max()
    assert np.abs(motion.energy().work - energy).max() < 3e-3 * energy.max()


@pytest.mark.filterwarnings("ignore:accelerations in the rows:beamfem.TimeStepWarning")  # of the pull on the pin
@pytest.mark.parametrize("method", [bf.Midpoint(), bf.Radau(2), bf.Radau(3)], ids=repr)
def test_a_motor_that_turns_a_steel_bar_needs_its_inertia_times_the_acceleration(method):
    """The torque of the midpoint rule was off by 4.4 times its largest value."""
    bar = bf.Beam(bf.Line((0, 0), (0.2, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.02), STEEL)
    motor = bf.Motor(bar.start, angle=lambda t: 0.5 * swinging(t)[0])
    motion = bf.simulate(bf.Model([bar], [bf.Pin(bar.start)], [motor]), 0.3, 1e-3, method)
    mass, (_, rate, acceleration) = 7800.0 * 4e-4 * 0.2, swinging(motion.time)
    inertia = mass * (0.2**2 / 3.0 + 0.02**2 / 12.0)
    torque, energy = 0.5 * inertia * acceleration, 0.125 * inertia * rate**2
    assert np.abs(motion.joint_force(motor)[:, 2] - torque).max() < 3e-3 * np.abs(torque).max()
    assert np.abs(motion.energy().work - energy).max() < 1e-2 * energy.max()


@pytest.mark.parametrize("kinked", [False, True])
def test_functions_are_asked_within_the_motion_only(kinked):
    """Found by mutation: a function of time need not exist before the start, nor after the end."""
    asked = []

    def record(time):
        asked.append(time)
        return 0.1 * time**2

    act = bf.Piecewise(record, (0.0, 0.0033, 0.0051, 0.01)) if kinked else record
    one, model = post(STEEL, record, loads=())
    model = bf.Model([one], model.supports, [bf.PointForce(one.end, (1.0, 0.0), amplitude=act)])
    bf.simulate(model, 0.01, 1e-3)
    assert min(asked) == 0.0
    assert max(asked) <= 0.01 * (1.0 + 1e-12)


def test_a_prescribed_motion_within_a_step_is_named():
    _, model = post(STEEL, lambda t: 1e-3 * np.sin(2.0 * np.pi * 1000.0 * t))
    with pytest.warns(
        UserWarning, match=r"motion prescribed by Prescribed at \(0, 0\).*varies more within the step from 0 s to 0.001"
    ):
        solution = bf.simulate(model, 0.01, 1e-3)
    assert "varies within steps" in solution.statistics.ended


def test_a_pendulum_on_a_trolley_of_constant_speed_swings_as_on_a_fixed_pin():
    """In a frame that moves with it, Newton's laws are the same."""
    rod = bf.Beam(bf.Line((0, 0), (0.5, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    weight, speed = bf.Gravity((0, -9.81)), np.array([3.0, -0.5])
    trolley = bf.Prescribed(rod.start, vx=lambda time: speed[0], vy=speed[1])
    riding, held = bf.Model([rod], [trolley], [weight]), bf.Model([rod], [bf.Pin(rod.start)], [weight])
    motion = bf.simulate(riding, 0.5, 1e-3, velocity=bf.RigidVelocity(tuple(speed)))
    still = bf.simulate(held, 0.5, 1e-3)
    moved = motion.position(rod.end) - np.outer(motion.time, speed)
    assert moved == pytest.approx(still.position(rod.end), abs=1e-7)
    assert motion.velocity(rod.start) == pytest.approx(np.tile(speed, (len(motion), 1)), abs=1e-9)


def test_a_prescribed_angular_velocity_is_that_of_a_motor():
    """It turns by its integral, and starts with its value."""
    arm = bf.Beam(bf.Line((0, 0), (0.5, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)

    def speed(time):
        return 2.0 + np.sin(5.0 * time)

    driven = bf.Model([arm], [bf.Pin(arm.start), bf.Prescribed(arm.start, angular=speed)])
    motors = bf.Model([arm], [bf.Pin(arm.start)], [bf.Motor(arm.start, speed=speed)])
    one, other = (bf.simulate(model, 0.3, 1e-3, velocity=bf.RigidVelocity(angular=2.0)) for model in (driven, motors))
    assert one.rotation(arm.start) == pytest.approx(2.0 * one.time + (1 - np.cos(5.0 * one.time)) / 5.0, abs=1e-12)
    assert one.p == pytest.approx(other.p, abs=1e-12)
    assert np.hypot(*one.velocity(arm.end)[0]) == pytest.approx(1.0, rel=1e-9)
    static = bf.solve_static(driven.with_(supports=[bf.Clamp(arm.end), bf.Prescribed(arm.start, vy=-1e-4)]), steps=2)
    assert static.displacement(arm.start)[:, 1] == pytest.approx([0.0, -5e-5, -1e-4], abs=1e-12)


def test_a_displacement_and_its_rate_are_not_both_prescribed():
    arm = bf.Beam(bf.Line((0, 0), (0.5, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    with pytest.raises(bf.InputError, match="takes uy or vy, not both"):
        bf.Prescribed(arm.start, uy=0.0, vy=1.0)
    with pytest.raises(bf.InputError, match="at least one of ux, uy, rotation, vx, vy and angular"):
        bf.Prescribed(arm.start)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5])
def test_a_motion_whose_steps_follow_a_tolerance_is_not_asked_beyond_its_end(tolerance):
    """Sums of steps went beyond it by round-off."""

    def swing(time):
        assert 0.0 <= time <= 0.3
        return 0.05 * np.sin(40.0 * time)

    plastic = bf.Material(2e9, 0.3, 1500.0)
    arm = bf.Beam(
        bf.Line((0, 0), (1, 0)), 3, bf.CRBF(3), bf.Rectangle(0.02, 0.02), plastic, damping=bf.KelvinVoigt(1e-4)
    )
    moved = bf.Prescribed(arm.start, ux=0.0, uy=swing, rotation=0.0)
    motion = bf.simulate(bf.Model([arm], [moved]), 0.3, tolerance=tolerance)
    assert motion.displacement(arm.start)[-1, 1] == pytest.approx(0.05 * np.sin(12.0), abs=1e-12)
