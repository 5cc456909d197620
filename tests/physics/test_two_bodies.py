"""A pendulum that carries a rod by one part, against equations of two rigid bodies with the energy of that part."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from slow_values import mostly_slow

import beamfem as bf

G, GAP, LENGTHS, SIDE = 9.81, 0.1, (1.0, 0.8), 0.02
STIFF = bf.Material(2e13, 0.3, 2700.0)
MASSES = [2700.0 * SIDE**2 * length for length in LENGTHS]
ROTARY = [mass * (length**2 + SIDE**2) / 12.0 for mass, length in zip(MASSES, LENGTHS, strict=True)]
INERTIAS = np.array([ROTARY[0] + 0.25 * MASSES[0] * LENGTHS[0] ** 2, MASSES[1], MASSES[1], ROTARY[1]])
INSTANTS = np.linspace(0.0, 0.5, 11)


def elongations(q):
    """Return the displacement of the rod's start relative to the pendulum's end, in its axes, and the angle."""
    turn, x, y, angle = q
    along = x - 0.5 * LENGTHS[1] * np.cos(angle) - LENGTHS[0] * np.cos(turn)
    above = y - 0.5 * LENGTHS[1] * np.sin(angle) - LENGTHS[0] * np.sin(turn)
    c, s = np.cos(turn), np.sin(turn)
    return np.array([c * along + s * above, -s * along + c * above, angle - turn])


def equations(forces):
    """Return y' for y = (q, q'), with forces of elongations and their rates."""

    def rates(time, y):
        q, velocity = y[:4], y[4:]
        by_angle = np.array([elongations(q + 1e-30j * unit).imag / 1e-30 for unit in np.eye(4)])
        weight = G * np.array([0.5 * MASSES[0] * LENGTHS[0] * np.cos(q[0]), 0.0, MASSES[1], 0.0])
        acting = -weight - by_angle @ forces(elongations(q), by_angle.T @ velocity)
        return np.append(velocity, acting / INERTIAS)

    return rates


def compare(part, forces, rise, longest=np.inf):
    """Assert that rod and pendulum move as the equations say, the rod with a velocity [m/s] upwards at first.

    longest [s]: step of the equations, whose forces may begin at any time.
    """
    section = bf.Rectangle(SIDE, SIDE)
    pendulum = bf.Beam(bf.Line((0, 0), (LENGTHS[0], 0)), 2, bf.CRBF(1), section, STIFF)
    start = LENGTHS[0] + GAP
    rod = bf.Beam(bf.Line((start, 0), (start + LENGTHS[1], 0)), 2, bf.CRBF(1), section, STIFF)
    connectors, gravity = [part(pendulum.end, rod.start)], [bf.Gravity((0.0, -G))]
    model = bf.Model([pendulum, rod], [bf.Pin(pendulum.start)], gravity, connectors=connectors)
    begin = np.array([0.0, start + 0.5 * LENGTHS[1], 0.0, 0.0, 0.0, 0.0, rise, 0.0])
    motion = bf.simulate(
        model, 0.5, tolerance=1e-8, save_at=INSTANTS, velocity=lambda x: (0.0, rise if x[0] > LENGTHS[0] else 0.0)
    )
    options = {"t_eval": INSTANTS, "rtol": 1e-9, "atol": 1e-11, "max_step": longest}
    expected = solve_ivp(equations(forces), (0.0, 0.5), begin, "DOP853", **options).y
    assert motion.position(rod.at(0.5)) == pytest.approx(expected[1:3].T, abs=3e-6)
    assert motion.rotation(rod.end) == pytest.approx(expected[3], abs=2e-5)
    assert motion.rotation(pendulum.end) == pytest.approx(expected[0], abs=2e-5)


@mostly_slow("damping", [(5.0, 3.0, 0.2), (0.0, 0.0, 0.0)])
def test_a_bushing_carries_a_rod(damping):
    stiffness = (2e3, 1e3, 5.0)

    def forces(elongation, rate):
        return np.array(stiffness) * (elongation - (GAP, 0.0, 0.0)) + np.array(damping) * rate

    compare(lambda a, b: bf.Bushing(a, b, stiffness, damping=damping), forces, 0.0)


@mostly_slow(("stiffness", "pretension"), [(2e3, 20.0), (2e4, 0.0)])
def test_a_cable_carries_a_rod_that_it_also_lets_go(stiffness, pretension):
    def forces(elongation, rate):
        x, y, _ = elongation.real
        length = np.hypot(x, y)
        return max(stiffness * (length - GAP) + pretension, 0.0) / length * np.array([x, y, 0.0])

    compare(lambda a, b: bf.Cable(a, b, stiffness, pretension=pretension), forces, 1.0, longest=5e-4)
