"""Motions of the verification manual."""

import numpy as np
from scipy.integrate import solve_ivp

import beamfem as bf
from studies.mechanisms import double_pendulum, slider_crank, spin_up
from studies.verification.case import Case, Value
from studies.verification.statics import compared

SPECTRAL = "spectral elements, 8th order in time"


def flying_beam() -> Case:
    """Simo and Vu-Quoc's flying beam."""
    section = bf.Section.from_stiffness(axial=1e4, shear=1e4, bending=100.0, mass=1.0, rotary_inertia=10.0)
    beam = bf.Beam(bf.Line((6, 0), (0, 8)), 8, bf.CRBF(4), section)
    pulse = bf.Interpolated(((0.0, 0.0), (2.5, 1.0), (5.0, 0.0), (100.0, 0.0)))
    loads = [
        bf.PointForce(beam.start, (8.0, 0.0), amplitude=pulse),
        bf.PointMoment(beam.start, -80.0, amplitude=pulse),
    ]
    model = bf.Model([beam], loads=loads)
    motion = bf.simulate(model, 6.0, 0.02, bf.Radau(3))
    first, last = motion.position(beam.start)[-1], motion.position(beam.end)[-1]
    found = (*map(float, (*first, *last)), float(motion.linear_momentum()[-1, 0]), float(motion.energy().strain[-1]))
    names = (
        "x of the loaded end",
        "y",
        "x of the other end",
        "y",
        "momentum along x",
        "strain energy",
    )  # of a total of 204.4
    exact = (7.17175765, 8.09726511, 12.15561698, -0.42551275, 20.0, 3.91266446)
    problem = "A free beam of length 10 is pushed and turned for 5 s; E I = 100, E A = k G A = 1e4. Values after 6 s."
    source = f"{SPECTRAL}; Simo and Vu-Quoc 1986"
    values = (*compared(names[:4], exact[:4], found[:4], 10.0), *compared(names[4:], exact[4:], found[4:], 204.4))
    return Case("Flying beam", problem, source, model, values, lambda path: motion.plot(path, shapes=13), 2e-5)


def soft_pendulum() -> Case:
    """The paper's pendulum."""
    soft = bf.Material(0.7e6, 0.3, 5540.0)
    beam = bf.Beam(bf.Line((0, 0), (1.2, 0)), 24, bf.CRBF(3), bf.Section(1.6e-3, 8.533e-6), soft)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])
    motion = bf.simulate(model, 0.5, 1e-4, save_every=100)
    found = (*map(float, motion.position(beam.end)[-1]), float(motion.energy().strain[-1]))
    values = compared(("x [m]", "y [m]", "strain energy [J]"), (0.354311304, -1.307082330, 15.356020152), found)
    problem = "A soft beam of 1.2 m on a pin falls from rest along x (Zheng and Shabana 2017); its tip after 0.5 s."
    return Case("Soft pendulum", problem, SPECTRAL, model, values, lambda path: motion.plot(path, shapes=6), 1e-5)


def rigid_pendulum() -> Case:
    """A stiff bar on a pin."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(2e13, 0.3, 7850.0))
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])
    motion = bf.simulate(model, 2.0, 1e-3)
    inertia = 1.0 / 3.0 + 0.02**2 / 12.0

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -0.5 * 9.81 * float(np.cos(y[0])) / inertia]

    exact = solve_ivp(rates, (0.0, 2.0), [0.0, 0.0], "DOP853", rtol=1e-12, atol=1e-12).y[0, -1]
    values = (Value("angle after 2 s [rad]", float(exact), float(motion.rotation(beam.start)[-1]), np.pi),)
    problem = "A stiff bar of 1 m falls from the horizontal about a pin and swings."
    return Case("Rigid pendulum", problem, "equation of a rigid body", model, values, motion.plot, 1e-5)


def double() -> Case:
    """A double pendulum of stiff bars."""
    motion = double_pendulum.main()
    turn = double_pendulum.bars(motion.time)[:, -1]
    exact = double_pendulum.LENGTH * np.array([np.cos(turn).sum(), np.sin(turn).sum()])
    tip = motion.position(motion.model.beams[1].end)[-1]
    values = compared(("x [m]", "y [m]"), (float(exact[0]), float(exact[1])), (float(tip[0]), float(tip[1])), 1.0)
    problem = "Two stiff bars of 0.5 m with a hinge fall from rest along x; the tip after 1 s."
    return Case("Double pendulum", problem, "equations of rigid bodies", motion.model, values, motion.plot, 1e-5)


def crank() -> Case:
    """The torque of a slider-crank."""
    run = slider_crank.main()["stiff rod"]
    exact = slider_crank.rigid_torque(run.motion.time)
    rows = [int(np.argmax(exact)), int(np.argmin(exact))]
    names = ("largest torque [N m]", "smallest torque [N m]")
    values = compared(names, tuple(map(float, exact[rows])), tuple(map(float, run.torque[rows])))
    problem = "A slider-crank of stiff bars, 0.15 m and 0.4 m, and a slider of 0.5 kg speeds up to 15 rad/s."
    return Case(
        "Slider-crank", problem, "virtual work of rigid bodies", run.motion.model, values, run.motion.plot, 2e-5
    )


def arm() -> Case:
    """A flexible arm that turns steadily in the end."""
    motion = spin_up.main()
    reach = float(np.hypot(*motion.position(motion.model.beams[0].end)[-1]))
    exact = spin_up.radius()
    values = (Value("stretch of the arm [m]", exact - spin_up.LENGTH, reach - spin_up.LENGTH),)
    problem = "A flexible arm of 1 m with a mass of 0.2 kg at its tip is spun up to 12 rad/s; its stretch in the end."
    return Case("Spin-up", problem, "equilibrium of a turning bar", motion.model, values, motion.plot, 1e-3)


def decay() -> Case:
    """A damped cantilever that vibrates in its first mode."""
    slender = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1.0, mass=1.0, rotary_inertia=1e-9)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), slender, damping=bf.KelvinVoigt(time=0.01))
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    omega = 1.875104068711961**2
    ratio = 0.5 * 0.01 * omega
    start = bf.solve_modes(model, 1).start(mode=0, amplitude=1e-4)
    period = 2.0 * np.pi / (omega * np.sqrt(1.0 - ratio**2))
    motion = bf.simulate(model, 10.0 * period, period / 40.0, bf.Radau(3), start=start)
    tip = motion.displacement(beam.end)[:, 1]
    lost = float(np.log(tip[40] / tip[400]) / 9.0)
    values = (Value("logarithmic decrement [-]", float(2.0 * np.pi * ratio / np.sqrt(1.0 - ratio**2)), lost),)
    problem = (
        "A cantilever, E I = rho A = L = 1, of Kelvin-Voigt material, retardation 0.01, vibrates in its first mode."
    )
    return Case(
        "Decaying vibration",
        problem,
        "damped oscillator",
        model,
        values,
        lambda p: motion.plot_history(beam.end, path=p),
        1e-4,
    )


def oscillator() -> Case:
    """A mass on a spring and a damper."""
    stiff = bf.Section.from_stiffness(axial=1e9, shear=1e9, bending=1e9, mass=1e-9, rotary_inertia=1e-9)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), stiff)
    guided = [bf.Prescribed(bar.start, uy=0.0, rotation=0.0)]
    spring = bf.SpringDamper(bar.start, (-1.0, 0.0), stiffness=100.0, damping=2.0)
    model = bf.Model([bar], guided, connectors=[spring], masses=[bf.PointMass(bar.start, 1.0)])
    motion = bf.simulate(model, 1.0, 1e-2, bf.Gauss(4), velocity=bf.RigidVelocity((1.0, 0.0)))
    swing = np.sqrt(100.0 - 1.0)
    exact = np.exp(-1.0) * np.sin(swing) / swing
    found = float(motion.displacement(bar.start)[-1, 0])
    values = (Value("displacement after 1 s [m]", float(exact), found),)
    problem = "1 kg on a spring of 100 N/m and a damper of 2 N s/m is struck to 1 m/s."
    source = "exp(-d t) sin(w t) / w"
    return Case(
        "Damped oscillator", problem, source, model, values, lambda p: motion.plot_history(bar.start, path=p), 1e-8
    )


def free_vibration() -> Case:
    """An arc that is let go from the shape of a mode."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    arc = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, np.pi / 2.0), 8, bf.CRBF(4), bf.Rectangle(0.02, 0.01), steel)
    model = bf.Model([arc], [bf.Clamp(arc.start)])
    modes, cycles, values = bf.solve_modes(model, 3), 10, list[Value]()
    for mode, frequency in enumerate(modes.frequencies.tolist()):
        start, time = modes.start(mode, amplitude=1e-4), (cycles + 0.25) / frequency  # where it passes through zero
        motion = bf.simulate(model, time, time / 410.0, bf.Gauss(4), start=start, save_every=410)
        moved = motion.displacement(arc.end)
        phase = 2.0 * np.pi * (cycles + 0.25) - float(moved[-1] @ moved[0] / (moved[0] @ moved[0]))
        values.append(Value(f"mode {mode + 1} [Hz]", frequency, phase / (2.0 * np.pi * time)))
    problem = "A quarter circle of steel, clamped at one end, is let go from its lowest modes, 0.1 mm large."
    return Case("Free vibration", problem, "solve_modes", model, tuple(values), modes.plot, 1e-5)


def snapping_arch() -> Case:
    """A shallow arch that snaps through under a sudden load."""
    rise, radius, load = 2e-3, 5e-4, 0.32
    section = bf.Section.from_stiffness(radius**-2, 100.0 * radius**-2, 1.0, 1.0, radius**2)

    def axis(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return x, rise * np.sin(np.pi * x)

    arch = bf.Beam(bf.Parametric(axis, 0.0, 1.0), 8, bf.CRBF(4), section)
    push = bf.DistributedLoad(arch, lambda s: (0.0, -load * float(np.sin(np.pi * s / arch.curve.length))))
    model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [push])
    motion = bf.simulate(model, 0.3, 2.5e-4, bf.Radau(3))

    def rates(_: float, y: np.ndarray) -> list[float]:
        stretch = 0.25 * np.pi**2 * (y[0] ** 2 - rise**2)
        return [y[1], -(np.pi**4) * (y[0] - rise) - np.pi**2 * stretch / radius**2 * y[0] - load]

    times = (0.1, 0.2, 0.3)
    exact = solve_ivp(rates, (0.0, 0.3), [rise, 0.0], "DOP853", times, rtol=1e-11, atol=1e-14).y[0]
    found = motion.position(arch.at(0.5))[[400, 800, 1200], 1]
    names = tuple(f"height after {time:g} s [m]" for time in times)
    values = compared(names, tuple(map(float, exact)), tuple(map(float, found)), rise)
    problem = (
        "A shallow sine arch on pins, E I = rho A = L = 1, rise 4 sqrt(I / A) = 2e-3, under a sudden load along a sine."
    )
    source = "one equation of motion, exact for shallow arches"
    return Case(
        "Snapping arch", problem, source, model, values, lambda p: motion.plot_history(arch.at(0.5), path=p), 1e-3
    )


CASES = (
    flying_beam,
    soft_pendulum,
    rigid_pendulum,
    double,
    crank,
    arm,
    decay,
    oscillator,
    free_vibration,
    snapping_arch,
)
