"""What loads, supports and joints of users return is checked before any solve."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from tests.own_parts import HalfWave


def bar():
    material = bf.Material(1e7, 0.3, 1000.0)
    return bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=2), bf.Rectangle(0.05, 0.1), material)


@dataclass(frozen=True)
class Along(bf.LineLoad):
    """Gives what it is told to."""

    beam: bf.Beam
    given: object
    axes: str = "plane"
    uniform: bool = False

    def forces(self, arc_length):
        return self.given(arc_length)


@dataclass(frozen=True)
class AtPoint(bf.PointLoad):
    """Gives what it is told to."""

    point: bf.Point
    value: object = None


@dataclass(frozen=True)
class Everywhere(bf.BodyLoad):
    """Gives what it is told to."""

    vector: object


@dataclass(frozen=True)
class Imposed(bf.ImposedStrain):
    """Gives what it is told to."""

    beam: bf.Beam
    given: object

    def free_strain(self, arc_length):
        return self.given(arc_length)


def two(value):
    return lambda s: np.full((len(s), 2), value)


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (lambda b: Along(b, lambda s: 1.0), r"forces of Along must return finite numbers \(3, 2\).*got shape \(\)"),
        (lambda b: Along(b, lambda s: np.ones((len(s), 3))), r"got shape \(3, 3\)"),
        (lambda b: Along(b, two(np.nan)), "must return finite numbers"),
        (lambda b: Along(b, two(1j)), "must return finite numbers"),
        (lambda b: Along(b, lambda s: 1 / 0), "cannot be computed: ZeroDivisionError"),
        (lambda b: Along(b, two(1.0), "local"), 'axes of Along must be "plane", "section" or "axis"'),
        (lambda b: Along(b, lambda s: np.column_stack([s, s]), "plane", True), "says that it is uniform"),
        (lambda b: Along(b, lambda s: two(1.0)(s) / (abs(s - 0.3) > 0.1)[:, None]), "must return finite numbers"),
        (lambda b: AtPoint(b.end, (1.0, 2.0)), "value of AtPoint must be fx, fy .* three numbers, got 2"),
        (lambda b: AtPoint(b.end, (0.0, -1j, 0.0)), "value of AtPoint must be a number"),
        (lambda b: AtPoint(b.end), "value of AtPoint must be a list"),
        (lambda b: Everywhere((0.0,)), "vector of Everywhere must be two finite numbers"),
        (lambda b: Imposed(b, lambda s: np.zeros((len(s), 3))), "free_strain of Imposed must return finite numbers"),
    ],
)
@pytest.mark.filterwarnings("ignore:divide by zero")
def test_loads(load, words):
    own = bar()
    with pytest.raises(bf.InputError, match=words):
        bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [load(own)]))


@dataclass(frozen=True)
class Stand(bf.PointSupport):
    """Prescribes what it is told to."""

    point: bf.Point
    given: object = None
    stiff: object = None
    direction: object = None

    def prescribed(self):
        return {} if self.given is None else self.given

    def springs(self):
        return {} if self.stiff is None else self.stiff


@dataclass(frozen=True)
class Bed(bf.LineSupport):
    """As stiff as it is told to be."""

    beam: bf.Beam
    stiffness: object


@pytest.mark.parametrize(
    ("support", "words"),
    [
        (lambda b: Stand(b.end), "Stand does nothing"),
        (lambda b: Stand(b.end, {"u": 0.0}), "prescribes an unknown direction; did you mean u"),
        (lambda b: Stand(b.end, {"ux": np.nan}), "ux that Stand prescribes must be finite"),
        (lambda b: Stand(b.end, [("ux", 0.0)]), r"prescribed\(\) of Stand must return a dict"),
        (lambda b: Stand(b.end, {"normal": 0.0}), "needs a direction"),
        (lambda b: Stand(b.end, {"normal": 0.0}, None, (1.0, 1.0)), "must be a unit vector"),
        (lambda b: Stand(b.end, {"normal": 0.1}, None, (0.6, 0.8)), "no displacement along its normal but 0.0"),
        (lambda b: Stand(b.end, None, {"uz": 1.0}), "spring in an unknown direction"),
        (lambda b: Stand(b.end, None, {"uy": -1.0}), "must be stiffer than zero"),
        (lambda b: Bed(b, (1.0,)), "stiffness of Bed must be two finite numbers"),
        (lambda b: Bed(b, (-1.0, 0.0)), "stiffness of Bed must not be negative"),
    ],
)
def test_supports(support, words):
    own = bar()
    with pytest.raises(bf.InputError, match=words):
        bf.Model([own], [bf.Clamp(own.start), support(own)])


@dataclass(frozen=True)
class Loose(bf.Joint):
    """Says neither yes nor no."""

    a: bf.Point
    b: bf.Point
    keeps_angle = 1


def test_joints():
    one, two = bar(), bar()
    with pytest.raises(bf.InputError, match="keeps_angle of Loose must be True or False"):
        Loose(one.end, two.start)


@dataclass(frozen=True)
class Standing(HalfWave):
    """Acts at load factor 0 already; has no field for an amplitude."""

    scale = False


def test_a_load_without_an_amplitude_may_stand_from_the_start():
    """The path from nothing to a large load at load factor 0 took every load for one with a field `amplitude`."""
    own, ours = bar(), bar()
    a = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [Standing(own, -4e3)]))
    wave = bf.DistributedLoad(ours, lambda s: (0.0, -4e3 * np.sin(np.pi * s)), scale=False)
    b = bf.solve_static(bf.Model([ours], [bf.Clamp(ours.start)], [wave]))
    assert abs(a.displacement(own.end)[-1, 1]) > 0.5
    assert a.p[-1] == pytest.approx(b.p[-1], abs=1e-9)
