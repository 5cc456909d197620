"""Models written for Abaqus, read back, and for OpenSeesPy, solved by a linear frame program of this file."""

import sys
from types import ModuleType

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
SECTION = bf.Rectangle(0.02, 0.03)


def portal(second=bf.Hinge, scale=1.0, more=(), supports=()):
    """A portal of 4 by 3 m with all kinds of loads that can be written."""
    left, right, bar = (
        bf.Beam(bf.Line(*ends), 4, bf.CRBF(4), SECTION, STEEL)
        for ends in (((0, 0), (0, 3)), ((4, 0), (4, 3)), ((0, 3), (4, 3)))
    )
    loads = [
        bf.PointForce(left.end, (800.0 * scale, 0.0)),
        bf.DistributedLoad(bar, (10.0 * scale, -200.0 * scale)),
        bf.Gravity((0.0, -9.81 * scale)),
        bf.PointMoment(bar.at(0.3), 100.0 * scale),
        *more,
    ]
    joints = [bf.Rigid(left.end, bar.start), second(right.end, bar.end)]
    return bf.Model([left, right, bar], [bf.Clamp(left.start), bf.Pin(right.start), *supports], loads, joints)


@pytest.mark.filterwarnings("ignore::beamfem.NotReadWarning")
def test_an_abaqus_file_that_is_read_back_is_the_same_structure(tmp_path):
    model = portal(bf.Rigid)
    bf.write_abaqus(model, tmp_path / "frame.inp", pieces=2)
    frame, top = bf.read_abaqus_model(tmp_path / "frame.inp", element=bf.CRBF(3)), model.beams[2]
    expected, found = bf.solve_static(model), bf.solve_static(frame.model)
    for point in (top.start, top.at(0.5), top.end):
        same = frame.frame.at(*point.reference)
        assert found.displacement(same)[-1] == pytest.approx(expected.displacement(point)[-1], rel=1e-5, abs=1e-8)
    assert frame.model.mass == pytest.approx(model.mass, rel=1e-9)


def test_hinges_displacements_and_followers_in_an_abaqus_file(tmp_path):
    beam = bf.Beam(
        bf.Arc((0, 0), 1.0, 0.0, np.pi), 4, bf.CRBF(3), lambda s: bf.Rectangle(0.01, 0.02 - 0.001 * s), STEEL
    )
    rod = bf.Beam(bf.Line((-1, 0), (-1, -1)), 1, bf.CRBF(3), SECTION, STEEL)
    supports = [bf.Pin(beam.start), bf.Prescribed(rod.end, ux=0.1, uy=0.0)]
    model = bf.Model(
        [beam, rod], supports, [bf.PointForce(rod.start, (1, 0), follower=True)], [bf.Hinge(beam.end, rod.start)]
    )
    bf.write_abaqus(model, tmp_path / "hinge.inp", pieces=2)
    text = (tmp_path / "hinge.inp").read_text()
    assert text.count("*BEAM GENERAL SECTION") == 8 + 1
    for line in ("*MPC\nPIN, 10, 9", "*CLOAD, FOLLOWER\n10, 1, 1.0", "*BOUNDARY\n12, 1, 1, 0.1", "*BOUNDARY\n12, 2\n"):
        assert line in text


class Linear(ModuleType):
    """What a script calls of OpenSeesPy, for small deflections."""

    def __init__(self):
        super().__init__("openseespy.opensees")
        self.nodes, self.elements, self.sections = {}, [], {}
        self.held, self.equal, self.loads, self.moved = set(), [], {}, {}

    def __getattr__(self, name):
        return lambda *arguments: None

    def node(self, tag, x, y):
        self.nodes[tag] = np.array([x, y])

    def section(self, kind, tag, e, a, i, g, factor):
        self.sections[tag] = e * a, e * i, g * a * factor

    def element(self, kind, tag, start, end, transformation, integration):
        self.elements.append((start, end, self.sections[integration]))

    def fix(self, node, *held):
        self.held |= {(node, axis) for axis in range(3) if held[axis]}

    def sp(self, node, axis, value):
        self.moved[node, axis - 1] = value

    def equalDOF(self, one, other, *axes):
        self.equal += [((one, axis - 1), (other, axis - 1)) for axis in axes]

    def load(self, node, *forces):
        self.loads[node] = np.array(forces)

    def analyze(self, steps):
        return 0

    def getNodeTags(self):
        return list(self.nodes)

    def nodeDisp(self, node):
        """Solve with Lagrange multipliers: Timoshenko elements, exact for forces at their ends."""
        at = {(tag, axis): 3 * n + axis for n, tag in enumerate(self.nodes) for axis in range(3)}
        size = len(at)
        stiffness, force = np.zeros((size, size)), np.zeros(size)
        for start, end, (ea, ei, ga) in self.elements:
            vector = self.nodes[end] - self.nodes[start]
            length = np.hypot(*vector)
            c, s = vector / length
            soft = np.diag([length / ea, length**3 / (3 * ei) + length / ga, length / ei])
            soft[1, 2] = soft[2, 1] = length**2 / (2 * ei)
            to_end = np.array([[-1, 0, 0, 1, 0, 0], [0, -1, -length, 0, 1, 0], [0, 0, -1, 0, 0, 1]])
            turn = np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))
            own = turn.T @ to_end.T @ np.linalg.inv(soft) @ to_end @ turn
            rows = [at[tag, axis] for tag in (start, end) for axis in range(3)]
            stiffness[np.ix_(rows, rows)] += own
        for tag, forces in self.loads.items():
            force[[at[tag, axis] for axis in range(3)]] += forces
        conditions = [({at[key]: 1.0}, 0.0) for key in self.held]
        conditions += [({at[key]: 1.0}, value) for key, value in self.moved.items()]
        conditions += [({at[one]: 1.0, at[other]: -1.0}, 0.0) for one, other in self.equal]
        rows = np.zeros((len(conditions), size))
        for row, (factors, _) in zip(rows, conditions, strict=True):
            row[list(factors)] = list(factors.values())
        scale = ei / length**3
        whole = np.block([[stiffness, scale * rows.T], [scale * rows, np.zeros((len(rows), len(rows)))]])
        right = np.concatenate([force, scale * np.array([value for _, value in conditions])])
        return np.linalg.solve(whole, right)[[at[node, axis] for axis in range(3)]]


def run(path, monkeypatch):
    """Run a script on the frame program above and return it."""
    package, linear = ModuleType("openseespy"), Linear()
    package.opensees = linear
    monkeypatch.setitem(sys.modules, "openseespy", package)
    monkeypatch.setitem(sys.modules, "openseespy.opensees", linear)
    linear.getNodeTags = list
    exec(path.read_text(), {})
    return linear


def test_a_script_for_opensees_is_the_same_structure(tmp_path, monkeypatch):
    """Large deflections were compared with OpenSeesPy 3.7.1 itself: a sway of 0.51062 m for 0.51069 m here."""
    model = portal(scale=1e-4)
    bf.write_opensees(model, tmp_path / "frame.py", pieces=16)
    linear, solution = run(tmp_path / "frame.py", monkeypatch), bf.solve_static(model)
    top = model.beams[2]
    for point in (top.start, top.at(0.5)):
        (tag,) = [tag for tag, place in linear.nodes.items() if np.allclose(place, point.reference)][:1]
        expected = [*solution.displacement(point)[-1], solution.rotation(point)[-1]]
        assert linear.nodeDisp(tag) == pytest.approx(expected, rel=2e-3, abs=2e-8)


def test_a_moved_support_in_a_script(tmp_path, monkeypatch):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=1e-4)])
    bf.write_opensees(model, tmp_path / "moved.py", pieces=1)
    linear = run(tmp_path / "moved.py", monkeypatch)
    assert linear.nodeDisp(2)[1] == pytest.approx(bf.solve_static(model).displacement(beam.at(0.5))[-1, 1], rel=1e-4)


@pytest.mark.parametrize("write", [bf.write_abaqus, bf.write_opensees])
def test_what_cannot_be_written_is_named(write, tmp_path):
    model = portal()
    left, right, bar = model.beams
    more = bf.Model(
        model.beams,
        [*model.supports, bf.Spring(bar.at(0.5), stiffness=(1.0, 1.0)), bf.Roller(bar.at(0.1), (1, 1))],
        [*model.loads, bf.Pressure(bar, 3.0), bf.Gravity((0, -1), scale=False)],
        model.joints,
        connectors=[bf.SpringDamper(left.at(0.5), right.at(0.5), stiffness=10.0)],
        masses=[bf.PointMass(bar.at(0.5), 3.0)],
    )
    names = "Spring, Roller, Pressure, Gravity, SpringDamper, PointMass"
    with pytest.warns(bf.NotWrittenWarning, match=names):
        write(more, tmp_path / "more.txt")
    layered = bf.Layered([bf.Layer(STEEL, 0.01)], 0.02, axis=0.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), layered)
    with pytest.raises(bf.InputError, match="coupled"):
        write(bf.Model([beam]), tmp_path / "layered.txt")
    with pytest.raises(bf.InputError, match="pieces"):
        write(model, tmp_path / "model.txt", pieces=0)


@pytest.mark.parametrize("write", [bf.write_abaqus, bf.write_opensees])
def test_laws_damping_and_frames_that_are_not_written_are_named(write, tmp_path):
    """Sections that yield became elastic without a word."""
    yielding = bf.Fibres(bf.Rectangle(0.01, 0.01), bf.ElasticPlastic(2e11, 3e8, 0.3, density=7800.0), points=4)
    spun = bf.RotatingFrame(1.0)
    for section, others, name in (
        (yielding, {}, "laws of sections"),
        (bf.Rectangle(0.01, 0.01), {"material": STEEL, "damping": bf.KelvinVoigt(1e-4)}, "damping"),
        (bf.Rectangle(0.01, 0.01), {"material": STEEL}, "RotatingFrame"),
    ):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), section, **others)
        model = bf.Model([beam], [bf.Clamp(beam.start)], frame=spun if name == "RotatingFrame" else None)
        with pytest.warns(bf.NotWrittenWarning, match=name):
            write(model, tmp_path / "model.txt")
