"""Vibrations of the verification manual."""

import numpy as np
from scipy.optimize import brentq

import beamfem as bf
from beamfem.section.protocol import CrossSection
from studies.verification.case import Case, Value
from studies.verification.statics import STEEL, compared

THICK = bf.Rectangle(0.1, 0.1)
BERNOULLI = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1.0, mass=1.0, rotary_inertia=1e-9)


def straight(section: CrossSection, elements: int = 8, material: bf.Material | None = None) -> bf.Beam:
    """Return a beam of length 1 along x."""
    return bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(4), section, material)


def names(count: int, unit: str) -> tuple[str, ...]:
    """Return the names of the lowest modes."""
    return tuple(f"mode {mode + 1} [{unit}]" for mode in range(count))


def angular(modes: bf.Modes, count: int) -> tuple[float, ...]:
    """Return the lowest angular frequencies [rad/s] that are no rigid motion."""
    found = 2.0 * np.pi * modes.frequencies[len(modes.rigid) :]
    return tuple(map(float, found[:count]))


def nearest(modes: bf.Modes, references: tuple[float, ...]) -> tuple[float, ...]:
    """Return the frequencies [Hz] that are nearest to some values: there are other kinds of modes between them."""
    return tuple(float(modes.frequencies[np.argmin(np.abs(modes.frequencies - value))]) for value in references)


def timoshenko() -> Case:
    """A thick cantilever and a thick free beam."""
    exact = (81.1554844278, 486.392833885, 1279.28741676), (502.714639119, 1307.65740193, 2385.22559166)
    values: tuple[Value, ...] = ()
    for ends, references in zip(("clamped", "free"), exact, strict=True):
        beam = straight(THICK, 8, STEEL)
        modes = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)] if ends == "clamped" else []), 8)
        bending = tuple(f"{ends}: bending {mode} [Hz]" for mode in (1, 2, 3))
        values += compared(bending, references, nearest(modes, references))
    problem = "A steel bar of 1 m and 100 mm square, L / h = 10, clamped at one end, and free."
    source = "roots of the exact determinant of Timoshenko's beam, 12 digits"
    return Case("Thick vibrating bars", problem, source, modes.model, values, modes.plot, 1e-6)


def axial() -> Case:
    """Axial vibrations of a bar."""
    beam = straight(THICK, 8, STEEL)
    held = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=0.0, rotation=0.0)])
    modes = bf.solve_modes(held, 12)
    references = (1265.9242088546, 3797.7726265637)
    values = compared(names(2, "Hz"), references, nearest(modes, references))
    problem = "The steel bar along its axis, fixed at one end: (2 n - 1) / 4 L sqrt(E / rho)."
    return Case("Axial vibration", problem, "exact", held, values, modes.plot, 1e-7)


def hanging() -> Case:
    """A heavy soft beam that hangs."""
    soft = bf.Material(0.7e6, 0.3, 5540.0)
    beam = bf.Beam(bf.Line((0, 0), (0, -1.2)), 8, bf.CRBF(4), bf.Section(1.6e-3, 8.533e-6), soft)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81), scale=False)])
    modes = bf.solve_modes(model, 6, about=bf.solve_static(model))
    references = tuple(value / (2.0 * np.pi) for value in (3.3623295908, 11.0874011563, 24.8057132271, 41.0713515312))
    problem = "A soft beam of 1.2 m hangs from a pin and is stretched by its weight (the paper's pendulum)."
    source = "collocation of Reissner's beam about the stretched state, 12 digits"
    values = compared(tuple(f"bending {mode + 1} [Hz]" for mode in range(4)), references, nearest(modes, references))
    return Case("Hanging beam", problem, source, model, values, modes.plot, 1e-6)


def tip_mass() -> Case:
    """A cantilever with a mass at its tip."""
    beam = straight(BERNOULLI)
    model = bf.Model([beam], [bf.Clamp(beam.start)], masses=[bf.PointMass(beam.end, 1.0)])

    def equation(b: float) -> float:
        return float(1.0 + np.cos(b) * np.cosh(b) + b * (np.cos(b) * np.sinh(b) - np.sin(b) * np.cosh(b)))

    references = tuple(brentq(equation, *bounds) ** 2 for bounds in ((1.0, 1.5), (3.5, 4.5), (6.5, 7.5)))
    modes = bf.solve_modes(model, 3)
    problem = "A slender cantilever, E I = rho A = L = 1, with a mass at its tip as heavy as itself."
    values = compared(names(3, "rad/s"), references, angular(modes, 3))
    return Case("Cantilever with a mass", problem, "Bernoulli's beam", model, values, modes.plot, 1e-5)


def pulled() -> Case:
    """A hinged beam under tension."""
    beam, tension = straight(BERNOULLI), 20.0
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [bf.PointForce(beam.end, (tension, 0.0))])
    modes = bf.solve_modes(model, 3, about=bf.solve_static(model))
    references = tuple((n * np.pi) ** 2 * np.sqrt(1.0 + tension / (n * np.pi) ** 2) for n in (1, 2, 3))
    problem = "A slender hinged beam, E I = rho A = L = 1, pulled by 20: (n pi)^2 sqrt(1 + T / (n pi)^2)."
    values = compared(names(3, "rad/s"), references, angular(modes, 3))
    return Case("Beam under tension", problem, "Bernoulli's beam", model, values, modes.plot, 1e-5)


def ring() -> Case:
    """A free ring in its plane."""
    slender = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1.0, mass=1.0, rotary_inertia=1e-9)
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2.0 * np.pi), 16, bf.CRBF(4), slender)
    model = bf.Model([beam], joints=[bf.Rigid(beam.start, beam.end)])
    modes = bf.solve_modes(model, 9)
    found = angular(modes, 5)
    n = np.array([2.0, 3.0, 4.0])
    exact = n * (n**2 - 1.0) / np.sqrt(n**2 + 1.0)
    values = compared(("2 waves [rad/s]", "3 waves [rad/s]"), (float(exact[0]), float(exact[1])), (found[0], found[2]))
    problem = "A free thin ring, E I = rho A = R = 1: n (n^2 - 1) / sqrt(n^2 + 1); each frequency is there twice."
    return Case("Vibrating ring", problem, "Hoppe 1871", model, values, modes.plot, 1e-5)


def rotating() -> Case:
    """A rotating cantilever."""
    references, found = (3.5160, 3.5432, 3.6218, 3.7435), []
    slender = bf.Section.from_stiffness(axial=1e6, shear=1e6, bending=1.0, mass=1.0, rotary_inertia=1e-6)
    for speed in range(4):
        beam = straight(slender)
        model = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(float(speed), about=(0.0, 0.0)))
        modes = bf.solve_modes(model, 1, about=bf.solve_static(model))
        found.append(angular(modes, 1)[0])
    values = compared(tuple(f"speed {speed} [rad/s]" for speed in range(4)), references, tuple(found))
    problem = "The lowest in-plane frequency of a cantilever, E I = rho A = L = 1, that rotates about its clamp."
    return Case("Rotating cantilever", problem, "Wright and others 1982; four digits", model, values, modes.plot, 1e-4)


def response() -> Case:
    """The steady response of a damped cantilever."""
    damped = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), BERNOULLI, damping=bf.Rayleigh(mass=0.2))
    model = bf.Model([damped], [bf.Clamp(damped.start)], [bf.PointForce(damped.end, (0.0, 1.0))])
    still = model.with_loads([bf.PointForce(damped.end, (0.0, 0.0))])
    at = np.array([0.3, 0.5, 2.0])
    force, quantity = bf.PointForce(damped.end, (0.0, 1.0)), ("uy", damped.end)
    found, drawn = (bf.frequency_response(still, force, quantity, f) for f in (at, np.linspace(0.1, 5.0, 200)))
    b = (((2.0 * np.pi * at) ** 2 - 0.2j * 2.0 * np.pi * at) ** 0.25).astype(complex)
    above = np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)
    exact = np.abs(above / (b**3 * (1.0 + np.cos(b) * np.cosh(b))))
    values = compared(
        tuple(f"{f:g} Hz: amplitude [m]" for f in at), tuple(map(float, exact)), tuple(map(float, found.amplitude))
    )
    problem = "A cantilever, E I = rho A = L = 1, damped by 0.2 v per length, under a harmonic unit force at its tip."
    return Case("Harmonic response", problem, "receptance of Bernoulli's beam", model, values, drawn.plot, 1e-4)


CASES = (timoshenko, axial, hanging, tip_mass, pulled, ring, rotating, response)
