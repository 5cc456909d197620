"""Parts of a user's own that are given by their energies: derived, compiled, and refused where they cannot be."""

import ctypes
from dataclasses import dataclass

import numpy as np
import pytest
from connectors import PointMass
from eccentric import Eccentric

import beamfem as bf
from beamfem.testing import check_connector

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)


def beams():
    return [bf.Beam(bf.Line((x, 0), (x, -1)), 4, bf.CRBF(2), SQUARE, STEEL) for x in (0.0, 0.5)]


def _arm_kinetic(q, v, data, f):
    (x, y, rate), distance = v[0], data[1]
    c, s = f.cos(q[0][2]), f.sin(q[0][2])
    return data[0] * ((x - distance * s * rate) ** 2 + (y + distance * c * rate) ** 2) / 2


def _arm_potential(q, data, gravity, f):
    c, s = f.cos(q[0][2]), f.sin(q[0][2])
    return -data[0] * (gravity[0] * (q[0][0] + data[1] * c) + gravity[1] * (q[0][1] + data[1] * s))


def _twist(q, data, gravity, f):
    """Depends on the difference of two angles inside a sine, as a magnetic torque does."""
    return -data[0] * f.cos(q[1][2] - q[0][2] - 1)


def _rods(q, data, f):
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return (f.sqrt(x * x + y * y) - data[0],)


ARM = bf.Connection("arm", 1, 3, ("mass", "distance"), _arm_kinetic, _arm_potential)
MAGNET = bf.Connection("magnet", 2, 3, ("strength",), potential=_twist)
ROD = bf.Connection("rod", 2, 2, ("length",), conditions=_rods, multipliers=1)


@dataclass(frozen=True)
class Part(bf.PartAtPoints):
    points: tuple[bf.Point, ...]
    connection: bf.Connection
    numbers: tuple[float, ...]

    def data(self, reference):
        return self.numbers


def hanging(part, both=False):
    one, two = beams()
    parts = [part(one, two)]
    return one, bf.Model(
        [one, two], [bf.Pin(one.start), bf.Pin(two.start)], [bf.Gravity((2.0, -9.81))], connectors=parts
    )


@pytest.mark.parametrize(
    "make",
    [
        lambda one, two: Part((one.end,), ARM, (2.0, 0.05)),
        lambda one, two: Part((one.end, two.end), MAGNET, (3.0,)),
        lambda one, two: Part((one.end, two.end), ROD, (0.5,)),
    ],
)
def test_parts_given_by_energies_are_consistent(make):
    check_connector(make(*beams()))


def test_a_body_given_by_its_energies_moves_as_one_given_by_its_force():
    ends = []
    for make in (lambda one, two: Part((one.end,), ARM, (2.0, 0.05)), lambda one, two: Eccentric(one.end, 2.0, 0.05)):
        one, model = hanging(make)
        ends.append(bf.simulate(model, 0.1, 1e-3).displacement(one.end)[-1])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-8)


def test_a_condition_with_a_root_is_a_link():
    ends = []
    for make in (lambda one, two: Part((one.end, two.end), ROD, (0.5,)), lambda one, two: bf.Link(one.end, two.end)):
        one, model = hanging(make)
        ends.append(bf.simulate(model, 0.1, 1e-3).displacement(one.end)[-1])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-7)


def test_what_cannot_be_derived_or_does_not_fit_is_refused():
    one, two = beams()
    wild = bf.Connection("wild", 1, 2, ("k",), potential=lambda q, data, gravity, f: np.exp(q[0][0]))
    for part, message in (
        (Part((one.end,), wild, (1.0,)), "wild cannot be derived from its energies"),
        (Part((one.end,), ARM, (1.0,)), r"must return 2 numbers \(mass, distance\), got 1"),
        (Part((one.end,), ARM, (1.0, np.nan)), "distance of Part must be finite"),
        (Part((one.end, two.end), ARM, (1.0, 0.1)), "arm is defined for 1 point, but Part has 2"),
    ):
        with pytest.raises(bf.InputError, match=message):
            bf.solve_static(bf.Model([one, two], [bf.Clamp(one.start), bf.Clamp(two.start)], connectors=[part]))


def test_a_part_without_shapes_is_drawn_as_a_line(tmp_path):
    one, two = beams()
    model = bf.Model([one, two], connectors=[Part((one.end, two.end), MAGNET, (3.0,))])
    (axes,) = model.plot(tmp_path / "magnet.svg").axes
    assert any(line.get_linestyle() == "--" for line in axes.lines)


def test_a_users_mass_counts_as_one_of_the_package():
    """Both worlds in one model: three masses at one point, each defined in another way, are one of their sum."""
    kinetic = lambda q, v, data, f: data[0] * (v[0][0] ** 2 + v[0][1] ** 2) / 2  # noqa: E731
    own = bf.Connection("own_mass", 1, 2, ("mass",), kinetic)
    (one, _), found = beams(), []
    for masses in (
        [bf.PointMass(one.end, 1.0), PointMass(one.end, 0.5), Part((one.end,), own, (0.3,))],
        [bf.PointMass(one.end, 1.8)],
    ):
        found.append(bf.solve_modes(bf.Model([one], [bf.Clamp(one.start)], masses=masses), 3).frequencies)
    np.testing.assert_allclose(found[0], found[1], rtol=1e-10)


_DOUBLES = ctypes.POINTER(ctypes.c_double)


@ctypes.CFUNCTYPE(None, *([_DOUBLES] * 8))
def _pull(q, v, a, own, turned, data, gravity, out):
    out[0], out[1] = data[0] * (q[0] - data[1]) ** 3, data[0] * (q[1] - data[2]) ** 3


@ctypes.CFUNCTYPE(None, *([_DOUBLES] * 7), *([ctypes.c_double] * 3), _DOUBLES)
def _pull_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    out[0], out[1], out[2] = ck * 3.0 * data[0] * (q[0] - data[1]) ** 2, 0.0, 0.0
    out[3] = ck * 3.0 * data[0] * (q[1] - data[2]) ** 2


def _pull_potential(q, data, gravity, f):
    return data[0] * ((q[0][0] - data[1]) ** 4 + (q[0][1] - data[2]) ** 4) / 4


def test_a_part_of_c_functions_is_the_one_of_its_energies():
    """Cubic springs to the ground, by the addresses of functions as C, Numba or ctypes make them."""
    names, numbers = ("stiffness", "x", "y"), (4e4, 0.1, -0.95)
    addresses = tuple(ctypes.cast(each, ctypes.c_void_p).value for each in (_pull, _pull_tangent))
    derived = bf.Connection("cubic", 1, 2, names, potential=_pull_potential)
    in_c = bf.Connection("cubic_in_c", 1, 2, names, potential=_pull_potential, compiled=addresses)
    ends = []
    for connection in (derived, in_c):
        one, model = hanging(lambda one, two, connection=connection: Part((one.end,), connection, numbers))
        check_connector(model.connectors[0])
        ends.append(bf.simulate(model, 0.1, 1e-3).displacement(one.end)[-1])
        clamped = model.with_(supports=[bf.Clamp(beam.start) for beam in model.beams])
        ends[-1] = np.append(ends[-1], bf.solve_static(clamped).displacement(one.end)[-1])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-8)


def test_parts_larger_than_the_room_of_compiled_code_are_refused():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SQUARE, STEEL)
    points = tuple(beam.at(k / 16) for k in range(17))
    large = bf.Connection("large", 17, 2, ("k",), compiled=(1, 1))
    with pytest.raises(bf.InputError, match="large has more than 32 coordinates or conditions"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[Part(points, large, (1.0,))]))
