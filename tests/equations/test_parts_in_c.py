"""Forces at points that are C functions, called by their addresses: the results of the same forces in formulas."""

import shutil
import subprocess
from ctypes import CDLL, c_void_p, cast
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from connectors import Anchor

import beamfem as bf
from beamfem.equations.history_variables import History
from beamfem.equations.system import system_of
from beamfem.errors import InputError
from beamfem.kernels.compiling import routine
from beamfem.testing import check_connector

SOURCE = """
static double trial(const double *q, const double *data) { return data[0] * (q[5] - q[2] - data[3]); }

void thrust(const double *q, const double *v, const double *a, const double *own, const double *turned,
            const double *data, const double *gravity, double *out) {
    double m = trial(q, data), limit = data[1];
    m = m > limit ? limit : m < -limit ? -limit : m;
    out[0] = -data[2] * turned[0]; out[1] = -data[2] * turned[1]; out[2] = -m;
    out[3] = 0.5 * v[3]; out[4] = 0.5 * v[4]; out[5] = m;
}

void thrust_tangent(const double *q, const double *v, const double *a, const double *own, const double *turned,
                    const double *data, const double *gravity, double ck, double cv, double ca, double *out) {
    double m = trial(q, data), k = m > data[1] || m < -data[1] ? 0.0 : ck * data[0];
    for (int i = 0; i < 36; i++) out[i] = 0.0;
    out[2] = ck * data[2] * turned[1]; out[8] = -ck * data[2] * turned[0];
    out[14] = out[35] = k; out[17] = out[32] = -k;
    out[21] = out[28] = 0.5 * cv;
}
"""


@routine("rrrrrrrr")
def thrust(q, v, a, own, turned, data, gravity, out):
    m, limit = data[0] * (q[5] - q[2] - data[3]), data[1]
    m = min(max(m, -limit), limit)
    out[0], out[1], out[2] = -data[2] * turned[0], -data[2] * turned[1], -m
    out[3], out[4], out[5] = 0.5 * v[3], 0.5 * v[4], m


@routine("rrrrrrrdddr")
def thrust_tangent(q, v, a, own, turned, data, gravity, ck, cv, ca, out):
    m, k = data[0] * (q[5] - q[2] - data[3]), ck * data[0]
    if abs(m) > data[1]:
        k = 0.0
    for i in range(36):
        out[i] = 0.0
    out[2], out[8] = ck * data[2] * turned[1], -ck * data[2] * turned[0]
    out[14], out[35], out[17], out[32] = k, k, -k, -k
    out[21], out[28] = 0.5 * cv, 0.5 * cv


@cache
def addresses(how, folder):
    if how == "llvm":
        return thrust.address, thrust_tangent.address
    if not (compiler := shutil.which("cc")):
        pytest.skip("no C compiler")
    source, library = folder / "force.c", folder / "force.so"
    source.write_text(SOURCE)
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
    own = CDLL(str(library))
    return cast(own.thrust, c_void_p).value, cast(own.thrust_tangent, c_void_p).value


def over(q, data, f):
    """Moment of a friction clutch, and change of its slip."""
    stiffness, limit, _, slip = data
    trial = stiffness * (q[1][2] - q[0][2] - slip)
    beyond = f.positive(trial - limit) - f.positive(-trial - limit)
    return trial - beyond, beyond / stiffness


def forces(q, v, data, f):
    """Return a thrust along the first section, drag on the second, and the moment of a clutch between them."""
    moment = over(q, data, f)[0]
    along = -data[2] * f.cos(q[0][2]), -data[2] * f.sin(q[0][2])
    return *along, -moment, v[1][0] / 2, v[1][1] / 2, moment


def slipped(q, v, data, f):
    return (data[3] + over(q, data, f)[1],)


NAMES = "stiffness", "limit", "thrust"


@dataclass(frozen=True)
class Clutch(bf.PartAtPoints):
    points: tuple[bf.Point, bf.Point]
    numbers: tuple[float, float, float]
    connection: bf.Connection
    conservative = False

    def data(self, reference):
        return self.numbers


def swung(analysis, compiled=None):
    own = {"force": forces, "remember": slipped, "compiled": compiled}
    connection = bf.Connection("clutch", 2, 3, NAMES, memory=("slip",), **own)
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    one, two = (bf.Beam(bf.Line((x, 0), (x + 1, 0)), 3, bf.CRBF(2), bf.Rectangle(0.02, 0.01), steel) for x in (0, 1))
    clutch = Clutch((one.end, two.start), (4e3, 2.0, 20.0), connection)
    check_connector(clutch)
    load = bf.PointForce(two.end, (0.0, -8.0), amplitude=lambda at: np.sin(7.0 * at), scale=False)
    supports, joints = [bf.Clamp(one.start)], [bf.Hinge(one.end, two.start)]
    if analysis == "static":
        supports.append(bf.Pin(two.end))
        load = bf.PointForce(one.end, (0.0, -60.0), amplitude=lambda at: np.sin(7.0 * at), scale=False)
    model = bf.Model([one, two], supports, [load], joints, [clutch])
    result = bf.solve_static(model, steps=20) if analysis == "static" else bf.simulate(model, 0.2, 1e-3)
    return result.displacement(two.at(0.5)), result.connector_force(clutch)


@pytest.mark.parametrize("how", ["llvm", "c"])
@pytest.mark.parametrize("analysis", ["static", "motion"])
def test_a_force_in_c_gives_the_results_of_its_formulas(how, analysis, tmp_path):
    moved, acting = swung(analysis, addresses(how, tmp_path))
    expected, resisting = swung(analysis)
    assert np.abs(resisting[:, 1, 2]).max() == pytest.approx(2.0)  # it slips
    np.testing.assert_allclose(moved, expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(acting, resisting, rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize("compiled", [(None, None), (0, 1), (7,)])
def test_what_is_no_address_is_refused(compiled):
    with pytest.raises(InputError, match="compiled of clutch must be the addresses of two C functions"):
        swung("static", compiled)


@pytest.mark.parametrize("python", [False, True], ids=["compiled", "with a part in Python"])
def test_history_that_steps_change_in_compiled_code_is_that_of_python(python, monkeypatch):
    """Friction in a clutch, and a stop on which the tip slides; both with energies that they have dissipated."""
    found = []
    for compiled in (True, False):
        if not compiled:
            monkeypatch.setattr(History, "compiled", False)
        steel = bf.Material(2.1e11, 0.3, 7850.0)
        shape = bf.Rectangle(0.02, 0.01)
        one, two = (bf.Beam(bf.Line((x, 0), (x + 1, 0)), 3, bf.CRBF(2), shape, steel) for x in (0, 1))
        own = bf.Connection("clutch", 2, 3, NAMES, memory=("slip",), force=forces, remember=slipped)
        parts = [
            Clutch((one.end, two.start), (4e3, 2.0, 20.0), own),
            bf.Stop(two.end, (0.0, 0.0), (0.0, 1.0), stiffness=300.0, friction=1e-3),
            *([Anchor(one.end, (3.0, 2.0, 1.0))] if python else []),
        ]
        hinge, gravity = bf.Hinge(one.end, two.start), bf.Gravity((0.0, -9.81))
        model = bf.Model([one, two], [bf.Clamp(one.start)], [gravity], [hinge], parts)
        found.append(bf.simulate(model, 0.4, 1e-3))
    one, other = found
    numbers = system_of(one.model, static=False).history.numbers
    assert (np.abs(one.p[-1, numbers]) > 1e-9).all()
    np.testing.assert_allclose(one.p, other.p, rtol=1e-9, atol=1e-12 * np.abs(other.p).max())
    np.testing.assert_allclose(one.energy().dissipated, other.energy().dissipated, rtol=1e-9, atol=1e-12)


def test_a_conservative_force_without_its_potential_is_refused(tmp_path):
    """Steps of motions are judged by the energy: without the potential, steps were cut for ever by Newmark's method."""

    class Declared(Clutch):
        conservative = True

    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    connection = bf.Connection(
        "clutch", 2, 3, NAMES, memory=("slip",), compiled=addresses("llvm", tmp_path), remember=slipped
    )
    part = Declared((beam.at(0.5), beam.end), (4e3, 2.0, 20.0), connection)
    model = bf.Model([beam], [bf.Clamp(beam.start)], connectors=[part])
    for solve in (bf.solve_static, lambda model: bf.simulate(model, 0.01, 1e-3, integrator=bf.Newmark())):
        with pytest.raises(InputError, match="has a force at rest without its potential; give the potential"):
            solve(model)


@pytest.mark.parametrize(
    ("remember", "message"),
    [
        (lambda q, v, data, f: (data[3], data[3]), r"must return 1 finite numbers, got \[0. 0.\]"),
        (lambda q, v, data, f: (1.0 / data[3],), "must return 1 finite numbers, got"),
        (lambda q, v, data, f: data[3], "must return 1 finite numbers, got 0"),
    ],
    ids=["too many", "infinite", "no tuple"],
)
def test_history_of_a_wrong_number_or_that_is_not_finite_is_refused_before_a_motion(remember, message):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    connection = bf.Connection("clutch", 2, 3, NAMES, memory=("slip",), force=forces, remember=remember)
    part = Clutch((beam.at(0.5), beam.end), (4e3, 2.0, 20.0), connection)
    with pytest.raises(InputError, match=f"remember of Clutch {message}"):
        bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[part]), 0.01, 1e-3)


@pytest.mark.parametrize("numbers", [None, 3.0])
def test_data_that_are_no_list_are_refused(numbers):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    connection = bf.Connection("clutch", 2, 3, NAMES, memory=("slip",), force=forces, remember=slipped)
    part = Clutch((beam.at(0.5), beam.end), numbers, connection)
    with pytest.raises(InputError, match="data of Clutch must be a list"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[part]))
