"""What loads, supports and joints of users tell wrongly is refused when a model is made of them."""

from dataclasses import dataclass, field

import numpy as np
import pytest

import beamfem as bf
from beamfem.model.load_base import forces_of
from tests.own_parts import Bracket, Growth, Guide, HalfWave, Traction, Weld

STEEL = bf.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000.0)


def bar(element=None, at=0.0):
    line = bf.Line((at, 0.0), (at + 1.0, 0.0))
    return bf.Beam(line, 4, element or bf.CRBF(order=2), bf.Rectangle(0.05, 0.1), STEEL)


def refused(kind, message, element=None, **members):
    """Make a model with a part of a class that is like `kind`, but for some members."""
    derived = dataclass(frozen=True)(type("Own", (kind,), {"__module__": __name__, **members}))
    beam = bar(element)
    given = {"beam": beam, "point": beam.end, "size": 1.0, "weight": 1.0, "arm": 1.0, "ratio": 0.1, "stiffness": 5.0}
    arguments = {name: given[name] for name in derived.__dataclass_fields__ if name in given}
    is_support = issubclass(kind, bf.PointSupport | bf.LineSupport)

    def modelled():
        part = derived(**arguments)
        return bf.Model([beam], [bf.Clamp(beam.start), *[part] * is_support], [part] * (not is_support))

    with pytest.raises(bf.InputError, match=message):
        modelled()


def returns(value):
    return lambda self, *_: value


@dataclass(frozen=True)
class Lift(bf.BodyLoad):
    vector = (0.0, 1.0)


@dataclass(frozen=True)
class Mat(bf.LineSupport):
    beam: bf.Beam
    stiffness = (0.0, 1.0)


@pytest.mark.parametrize("axes", ["plane", "section", "axis"])
@pytest.mark.parametrize("uniform", [True, False])
@pytest.mark.parametrize(
    "forces",
    [
        lambda self, s: np.ones(len(s)),
        lambda self, s: np.ones((len(s), 1)),
        lambda self, s: np.ones((len(s), 3)),
        lambda self, s: np.ones(2),
        lambda self, s: np.ones((1, 2)),
        lambda self, s: np.full((len(s), 2), np.nan),
        lambda self, s: np.full((len(s), 2), 1j),
        lambda self, s: [["a", "b"]] * len(s),
        lambda self, s: 5.0,
        lambda self, s: None,
        lambda self, s: 1 / 0,
    ],
)
def test_forces_of_another_shape_are_refused(axes, uniform, forces):
    refused(HalfWave, "forces of Own", axes=axes, uniform=uniform, forces=forces)


@pytest.mark.parametrize("axes", ["Section", "x", None, 3, ["plane"]])
def test_unknown_axes_are_refused(axes):
    refused(HalfWave, 'axes of Own must be "plane", "section" or "axis"', axes=axes)


def test_forces_of_another_shape_between_the_first_looks_are_refused():
    @dataclass(frozen=True)
    class Odd(HalfWave):
        def forces(self, arc_length):
            return np.full((len(arc_length), 2), np.nan if len(arc_length) != 3 else 1.0)

    beam = bar()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [Odd(beam, 1.0)])
    with pytest.raises(bf.InputError, match="forces of Odd must be an array"):
        bf.solve_static(model)
    assert np.array_equal(forces_of(Traction(beam, 2.0), np.zeros(1)), [[2.0, 0.0]])


def test_what_is_called_uniform_must_be():
    refused(HalfWave, "uniform of Own is True, but its forces change", uniform=True)
    refused(HalfWave, "uniform of Own must be True or False", uniform="no")


@pytest.mark.parametrize("along", ["size", ("length",), (3,)])
def test_names_along_a_beam_must_be_fields(along):
    refused(HalfWave, "along of Own", along=along)
    refused(Growth, "along of Own", along=along)


@pytest.mark.parametrize(
    "value",
    [(0.0, 1.0), (0.0, 1.0, 2.0, 3.0), (0.0, np.nan, 0.0), ("1", "2", "3"), None, 5.0, (1j, 0, 0), (True, 0, 0)],
)
def test_values_of_point_loads_are_three_numbers(value):
    refused(Bracket, "value of Own", value=property(returns(value)))


@pytest.mark.parametrize("vector", [-9.81, (0.0, 1.0, 2.0), "down", (0.0, np.nan), None, lambda time: (0.0, time)])
def test_accelerations_are_two_numbers(vector):
    refused(Lift, "vector of Own must be two", vector=property(returns(vector)))


@pytest.mark.parametrize("shape", [(3,), (3, 3), (1, 4), (4, 3), (3, 5)])
@pytest.mark.parametrize("element", [bf.CRBF(order=2), bf.ANCF()], ids=str)
def test_free_strains_of_another_shape_are_refused(element, shape):
    refused(Growth, "free_strain of Own must", element=element, free_strain=returns(np.zeros(shape)))
    refused(Growth, "heat of Own must", element=element, heat=returns(np.zeros(3)))


def test_strains_that_nodes_cannot_take_are_refused():
    refused(Growth, "Own: nodes of .* do not stretch", element=bf.ShearRigid(stretchable=False))
    refused(Growth, "units of Own must name a unit for each name of along", units=())


@pytest.mark.parametrize(
    ("prescribed", "message"),
    [
        ({"uz": 0.0}, "unknown direction 'uz'; .*nown are ux, uy, rotation, normal"),
        ({"uy": "0"}, "uy prescribed by Own must be a number"),
        ({"uy": None}, "uy prescribed by Own must be a number"),
        ({"uy": np.nan}, "uy prescribed by Own must be finite"),
        ({"uy": True}, "uy prescribed by Own must be a number"),
        ({"uy": lambda time, more: 0.0}, "uy prescribed by Own must be a function of time alone"),
        ({"normal": 0.0}, "direction of Own must be a unit vector"),
        (["uy"], "prescribed of Own must return a dict"),
        (None, "prescribed of Own must return a dict"),
    ],
)
def test_what_is_prescribed_must_be_known(prescribed, message):
    refused(Guide, message, prescribed=returns(prescribed))


@pytest.mark.parametrize("value", [0.01, lambda time: 0.01 * time])
@pytest.mark.parametrize("direction", [(1.0, 0.0), (-1.0, 0.0), (0.6, 0.8)])
def test_a_normal_displacement_cannot_be_moved(value, direction):
    members = {"prescribed": returns({"normal": value}), "direction": property(returns(np.array(direction)))}
    refused(Guide, "normal prescribed by Own must be 0.0", **members)


@pytest.mark.parametrize("direction", [(3.0, 4.0), (0.0, 0.0), (0.6, 0.8, 0.0), (np.nan, 1.0), "xy"])
def test_directions_are_unit_vectors(direction):
    members = {"prescribed": returns({"normal": 0.0}), "direction": property(returns(direction))}
    refused(Guide, "direction of Own must be", **members)


def test_a_direction_along_which_nothing_is_prescribed_is_refused():
    refused(Guide, 'direction of Own is given, but prescribed.* no "normal"', direction=property(returns((0.6, 0.8))))


@pytest.mark.parametrize(
    ("springs", "message"),
    [
        ({"uy": -5.0}, "stiffness of Own in uy must be greater than zero"),
        ({"uy": 0.0}, "stiffness of Own in uy must be greater than zero"),
        ({"uy": "5"}, "stiffness of Own in uy must be a number"),
        ({"uy": np.nan}, "stiffness of Own in uy must be finite"),
        ({"normal": 5.0}, "unknown direction 'normal'"),
        ([5.0], "springs of Own must return a dict"),
    ],
)
def test_springs_have_stiffness_by_direction(springs, message):
    refused(Guide, message, springs=returns(springs))


def test_supports_that_do_nothing_are_refused():
    refused(Guide, "Own does nothing", prescribed=returns({}), springs=returns({}))


@pytest.mark.parametrize("stiffness", [50.0, (1.0,), (0.0, -5.0), (0.0, 0.0), (0.0, np.nan), None, ("1", "2")])
def test_springs_along_a_beam_have_stiffness(stiffness):
    refused(Mat, "stiffness of a? ?Own must", stiffness=property(returns(stiffness)))


@pytest.mark.parametrize("keeps_angle", [1, 0, "yes", None])
def test_joints_keep_the_angle_or_do_not(keeps_angle):
    @dataclass(frozen=True)
    class Own(bf.Joint):
        a: bf.Point
        b: bf.Point

    Own.keeps_angle = keeps_angle
    one, two = bar(), bar(at=1.0)
    with pytest.raises(bf.InputError, match="keeps_angle of Own must be True or False"):
        bf.Model([one, two], [bf.Clamp(one.start)], [], [Own(one.end, two.start)])


def test_joints_that_know_their_angle_from_numpy_join():
    @dataclass(frozen=True)
    class Own(bf.Joint):
        a: bf.Point
        b: bf.Point
        keeps_angle = np.True_

    def turned(joint):
        one, two = bar(), bar(at=1.0)
        load = bf.PointForce(two.at(0.5), (0.0, -5.0))
        model = bf.Model([one, two], [bf.Clamp(one.start)], [load], [joint(one.end, two.start)])
        return bf.solve_static(model).p

    assert np.array_equal(turned(Own), turned(Weld))


def test_places_are_looked_at_where_a_class_does_not():
    @dataclass(frozen=True)
    class Own(Bracket):
        amplitude: object = None
        scale: object = True
        follower: object = False

        def __post_init__(self):
            pass

    beam = bar()
    for point, given, message in [
        (None, {}, "point of Own must be a Point"),
        (beam, {}, "point of Own must be a Point"),
        (beam.end, {"amplitude": 3.0}, "amplitude of Own must be a function of time"),
        (beam.end, {"scale": "no"}, "scale of Own must be True or False"),
        (beam.end, {"follower": 1}, "follower of Own must be True or False"),
    ]:
        with pytest.raises(bf.InputError, match=message):
            bf.Model([beam], [bf.Clamp(beam.start)], [Own(point, 1.0, 1.0, **given)])


def test_an_amplitude_is_no_property():
    refused(Bracket, "amplitude of Own must be a field or a method", amplitude=property(returns(abs)))


def test_parts_that_can_change_are_refused():
    @dataclass
    class Own(bf.PointLoad):
        point: bf.Point
        value: tuple = field(default=(0.0, 1.0, 0.0))

    beam = bar()
    with pytest.raises(bf.InputError, match="Own, one of the loads of a Model, must be a frozen dataclass"):
        bf.Model([beam], [bf.Clamp(beam.start)], [Own(beam.end)])


@dataclass(frozen=True)
class Warmed(bf.ImposedStrain):
    beam: bf.Beam
    gradient: object

    def free_strain(self, arc_length):
        return np.outer(self.gradient(arc_length), [0.0, 0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Tug(bf.PointLoad):
    point: bf.Point
    law: object
    value = (0.0, 1.0, 0.0)


def test_a_function_that_a_file_has_no_place_for_is_named_with_what_to_do(tmp_path):
    beam = bar()
    for load, said in (
        (
            Warmed(beam, lambda s: 0.1 * s),
            "its field gradient is a function; if it is one of the arc length, name it in",
        ),
        (Tug(beam.end, abs), "its field law is a function; make it a method of the class"),
    ):
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))
        with pytest.raises(bf.InputError, match=f"a {type(load).__name__} cannot be saved: {said}"):
            solution.save(tmp_path / "own.h5")
