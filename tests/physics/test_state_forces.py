"""Forces as functions of time and state."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.testing import check_connector

STEEL, SQUARE = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.01, 0.01)
ROD = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SQUARE, STEEL)
CLAMP = bf.Clamp(ROD.start)


@dataclass(frozen=True)
class Thrust:
    """A thrust [N] across the section that grows with the load factor."""

    size: float

    def __call__(self, time, q, v):
        return -time * self.size * np.sin(q[2]), time * self.size * np.cos(q[2]), 0.0


def test_a_thrust_across_a_section_is_a_follower_force(tmp_path):
    thruster = bf.StateForce(ROD.end, Thrust(400.0))
    check_connector(thruster)
    own = bf.solve_static(bf.Model([ROD], [CLAMP], connectors=[thruster]))
    load = bf.PointForce(ROD.end, (0.0, 400.0), follower=True)
    other = bf.solve_static(bf.Model([ROD], [CLAMP], [load]))
    assert other.displacement(ROD.end)[-1, 1] > 0.5
    np.testing.assert_allclose(own.position(ROD.end)[-1], other.position(ROD.end)[-1], rtol=1e-9)
    forces = own.connector_force(thruster)[-1, 0]
    np.testing.assert_allclose(forces, Thrust(400.0)(1.0, [0.0, 0.0, own.rotation(ROD.end)[-1]], None), rtol=1e-9)
    own.save(tmp_path / "a.h5")
    assert bf.load(tmp_path / "a.h5").model.connectors[0].function == Thrust(400.0)
    own.model.plot(tmp_path / "a.png")


def test_a_controller_of_two_points_is_a_spring_and_its_work_is_counted():
    """Also one with corners, which no complex step sees."""
    other = bf.Beam(bf.Line((0, 1), (1, 1)), 4, bf.CRBF(3), SQUARE, STEEL)
    supports, push = [CLAMP, bf.Clamp(other.start)], bf.PointForce(ROD.end, (0.0, -50.0))

    def pull(time, q, v):
        along = q[1, :2] - q[0, :2]
        length = np.hypot(*along)
        force = 3e3 * max(length - 1.0, -1.0) + 20.0 * (along @ (v[1, :2] - v[0, :2])) / length
        on_first = np.append(force * along / length, 0.0)
        return np.array([on_first, -on_first])

    ends = ROD.end, other.end
    controller, spring = bf.StateForce(ends, pull), bf.SpringDamper(*ends, 3e3, 20.0)
    models = [bf.Model([ROD, other], supports, [push], connectors=[part]) for part in (controller, spring)]
    one, two = (bf.solve_static(model).position(ROD.end)[-1] for model in models)
    np.testing.assert_allclose(one, two, rtol=0, atol=1e-10)
    moved = [bf.simulate(model, 0.05, 2e-4) for model in models]
    np.testing.assert_allclose(*(motion.position(ROD.end) for motion in moved), rtol=0, atol=1e-9)
    energy = moved[0].energy()
    assert np.abs(energy.error).max() < 1e-4 * energy.strain.max()
    assert energy.work.min() < -0.1


def test_functions_of_other_arguments_and_results_are_refused():
    with pytest.raises(bf.InputError, match="function of a StateForce takes time, q and v"):
        bf.StateForce(ROD.end, lambda time: 0.0)
    model = bf.Model([ROD], [CLAMP], connectors=[bf.StateForce(ROD.end, lambda time, q, v: 1.0)])
    with pytest.raises(bf.InputError, match=r"must return fx, fy and moment \(3,\), got \(\)"):
        bf.solve_static(model)


@pytest.mark.parametrize("length", [1e-6, 1e-3, 1.0])
def test_a_nonlinear_force_has_its_tangent_at_every_size_of_a_model(length):
    """A magnet at 1/20 of the length, c / gap^2, in models from a micrometre on: differences are as small as these."""
    axis, section = bf.Line((0, 0), (length, 0)), bf.Rectangle(0.01 * length, 0.01 * length)
    rod, gap = bf.Beam(axis, 4, bf.CRBF(3), section, STEEL), 0.05 * length
    strength = 0.2 * length**2 * gap**2

    def pull(time, q, v):
        return 0.0, strength / (gap - q[1]) ** 2, 0.0

    model = bf.Model([rod], [bf.Clamp(rod.start)], connectors=[bf.StateForce(rod.end, pull)])
    drawn = bf.solve_static(model)
    rest = gap - drawn.displacement(rod.end)[-1, 1]
    held = bf.Model([rod], [bf.Clamp(rod.start)], [bf.PointForce(rod.end, (0.0, strength / rest**2))])
    own, other = (bf.linearise(each, about=about) for each, about in ((model, drawn), (held, bf.solve_static(held))))
    tip = own.names.index("beam 0, node 12, r^y")
    assert (other.stiffness - own.stiffness)[tip, tip] == pytest.approx(2.0 * strength / rest**3, rel=1e-5)


@pytest.mark.parametrize(
    ("part", "message"),
    [
        (bf.StateForce(ROD.end, lambda time, q, v: 1 / 0), "function of StateForce"),
        (bf.Motor(ROD.end, torque=lambda time, angle, speed: 1 / 0), "torque of Motor"),
    ],
)
def test_a_function_that_fails_is_named_with_its_own_arguments(part, message):
    parts = {"loads": [part]} if isinstance(part, bf.Motor) else {"connectors": [part]}
    with pytest.raises(bf.InputError, match=rf"^{message}\(0\.5, [^A]* cannot be computed: ZeroDivisionError"):
        bf.solve_static(bf.Model([ROD], [CLAMP], **parts))


def test_numbers_beyond_those_of_the_computer_are_refused_before_a_solve():
    with pytest.raises(bf.InputError, match=r"stiffness of SpringDamper is 1e\+308, .* cannot square"):
        bf.SpringDamper(ROD.end, (1.0, 1.0), 1e308)
