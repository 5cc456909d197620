"""What model files describe is what Python describes, to the last digit: elements, layers, meshes, starts, branches."""

from pathlib import Path
from shutil import copyfile

import pytest
from model_file_pairs import ARM, LIFT, STEEL, arm, from_file, held, require_same

import beamfem as bf
from beamfem.cli.modelfile import ModelFileError, read_model_file

MESHES = Path(__file__).parent.parent / "meshes"
CRBF = 'element = { kind = "CRBF", order = 3 }'
ELEMENTS = {
    '{ kind = "Element", field = "cubic", coordinates = "gradients", forces = "elastic-line" }': bf.Element(
        bf.Cubic(), bf.Gradients(), bf.ElasticLine()
    ),
    '{ kind = "Element", field = { kind = "lagrange", order = 2 }, coordinates = "rotation", forces = "structural", '
    'integration = "reduced", label = "mine" }': bf.Element(
        bf.Lagrange(2), bf.Rotation(), bf.Structural(), "reduced", "mine"
    ),
    '{ kind = "Element", field = "cubic", coordinates = { kind = "shear-free", stretchable = false }, '
    'forces = "structural" }': bf.Element(bf.Cubic(), bf.ShearFree(False), bf.Structural()),
    '{ kind = "Element", field = "lagrange", coordinates = "gradients", '
    'forces = { kind = "continuum", plane_stress = true } }': bf.Element(
        bf.Lagrange(), bf.Gradients(), bf.ContinuumMechanics(True)
    ),
}


@pytest.mark.parametrize("text", ELEMENTS)
def test_an_element_of_field_coordinates_and_forces(text, tmp_path):
    found = from_file(tmp_path / "a.toml", ARM.replace(CRBF, f"element = {text}") + LIFT)
    assert found.solution.model.beams[0].element == ELEMENTS[text]
    require_same(found.solution, bf.solve_static(held(arm(element=ELEMENTS[text]))))


def test_an_element_may_have_a_name(tmp_path):
    text, element = next(iter(ELEMENTS.items()))
    named = f"[elements.mine]\n{text.strip('{} ').replace(', ', chr(10))}\n"
    found = from_file(tmp_path / "a.toml", named + ARM.replace(CRBF, 'element = "mine"') + LIFT)
    assert found.solution.model.beams[0].element == element


def test_layers_whose_thickness_varies(tmp_path):
    section = """section = { kind = "layered", width = 0.01, axis = 0.004, layers = [
  { material = "steel", thickness = { kind = "table", points = [[0, 0.008], [0.6, 0.008], [1, 0.002]] } },
  { material = { youngs_modulus = 7e10, poisson_ratio = 0.33, density = 2700 }, thickness = 0.003 },
] }"""
    text = ARM.replace('section = { kind = "rectangle", width = 0.01, height = 0.01 }', section)
    thickness, soft = bf.Interpolated([[0, 0.008], [0.6, 0.008], [1, 0.002]]), bf.Material(7e10, 0.33, 2700)

    def layered(arc_length):
        return bf.Layered([bf.Layer(STEEL, thickness(arc_length)), bf.Layer(soft, 0.003)], 0.01, 0.004)

    found = from_file(tmp_path / "a.toml", text + LIFT).solution
    assert found.model.beams[0].section_at(0.8) == layered(0.8)
    assert found.model.meshes[0].elements == 5  # elements end at the kink
    require_same(found, bf.solve_static(held(arm(section=bf.Piecewise(layered, thickness.kinks)))))


def test_graded_meshes_and_splines_through_points(tmp_path):
    curve = '{ kind = "hermite", u = [0, 1, 2], r = [[0, 0], [1, 0.2], [2, 0]], r_u = [[1, 0.3], [1, 0], [1, -0.3]] }'
    text = ARM.replace("elements = 4", 'elements = { kind = "graded", elements = 5, ratio = 3 }').replace(
        '{ kind = "line", start = [0, 0], end = [1, 0] }', curve
    )
    spline = bf.spline_through_hermite([0, 1, 2], [[0, 0], [1, 0.2], [2, 0]], [[1, 0.3], [1, 0], [1, -0.3]])
    found = from_file(tmp_path / "a.toml", text + LIFT).solution
    require_same(found, bf.solve_static(held(arm(bf.graded(5, 3), curve=spline))))


def test_states_at_load_factors(tmp_path):
    text = (
        '[analysis]\nkind = "static"\nat = [0.25, 0.5]\n[[outputs]]\npoint = "arm.end"\nquantities = ["uy"]\nat = [0.3]'
    )
    found = from_file(tmp_path / "a.toml", ARM + LIFT + text).solution
    require_same(found, bf.solve_static(held(arm()), at=[0.25, 0.3, 0.5]))


AMPLITUDE = 'amplitude = { kind = "table", points = [[0, 1], [1, 0]] }\n'


@pytest.mark.parametrize("start", ["0.4", "{ load_factor = 0.4, steps = 2, newton = { iterations = 20 } }", "file"])
def test_a_motion_starts_from_an_equilibrium(start, tmp_path):
    beam = arm()
    model = held(beam, [bf.PointForce(beam.end, (0, 100), bf.Interpolated([[0, 1], [1, 0]]))])
    options = {"steps": 2, "newton": bf.Newton(iterations=20)} if "steps" in start else {}
    rest = bf.solve_static(model, at=[0.4], **options)
    if start == "file":
        bf.solve_static(model, at=[0.4, 1.0]).save(tmp_path / "before.h5")
        start, rest = '{ file = "before.h5", row = 1 }', bf.load(tmp_path / "before.h5")[:1]
    text = f'[analysis]\nkind = "dynamics"\nduration = 0.01\nstep = 1e-3\nrho_inf = 0.8\nstart = {start}\n'
    found = from_file(tmp_path / "a.toml", ARM + LIFT.replace("vector", AMPLITUDE + "vector") + text).solution
    require_same(found, bf.simulate(model, 0.01, 1e-3, bf.GeneralizedAlpha(0.8), rest[-1]))


def test_modes_and_critical_loads_about_an_equilibrium(tmp_path):
    model = held(arm())
    about = bf.solve_static(model, at=[0.5])
    text = '[analysis]\nkind = "modes"\ncount = 3\nabout = 0.5\namplitude = 0.02\nframes = 7\nmode = 2\n'
    found = from_file(tmp_path / "a.toml", ARM + LIFT + text)
    modes = bf.solve_modes(model, 3, about)
    assert found.values["frequencies"] == modes.frequencies.tolist()
    require_same(found.solution, modes.solution(1, 0.02, 7))
    pushed = LIFT.replace("[0, 100]", "[-600, 0]")
    text = '[analysis]\nkind = "buckling"\ncount = 1\nabout = 0.3\namplitude = 0.02\n'
    found = from_file(tmp_path / "a.toml", ARM + pushed + text)
    model = held(beam := arm(), [bf.PointForce(beam.end, (-600, 0))])
    buckling = bf.solve_buckling(model, 1, bf.solve_static(model, at=[0.3]))
    assert found.values["load_factors"] == buckling.load_factors.tolist()
    require_same(found.solution, buckling.solution(0, 0.02))


def test_an_imperfection_by_a_mode_about_an_equilibrium(tmp_path):
    text = '[imperfection]\nsize = 0.01\nof = "modes"\nabout = "static"\nmode = 2\n'
    found = from_file(tmp_path / "a.toml", ARM + LIFT + text)
    model = held(arm())
    crooked = model.with_imperfection(bf.solve_modes(model, 2, bf.solve_static(model)[-1]), 0.01, 1)
    require_same(found.solution, bf.solve_static(crooked))


def test_reactions_inside_a_crooked_beam(tmp_path):
    roller = '[[supports]]\nkind = "roller"\npoint = "arm.at(0.4)"\n'
    crooked = '[imperfection]\nsize = 0.05\nof = "modes"\n'
    output = '[[outputs]]\npoint = "arm.at(0.4)"\nquantities = ["fy"]\n'
    (tmp_path / "a.toml").write_text(ARM + roller + LIFT + crooked + output)
    job = read_model_file(tmp_path / "a.toml").imperfect()
    beam = arm()
    supports = [bf.Clamp(beam.start), bf.Roller(beam.at(0.4))]
    straight = bf.Model([beam], supports, [bf.PointForce(beam.end, (0, 100))])
    expected = bf.solve_static(straight.with_imperfection(bf.solve_modes(straight, 1), 0.05))
    found = job.solve().solution
    require_same(found, expected)
    fy = expected.reaction(expected.model.supports[1].point)[-1, 1]
    assert job.outputs[0].rows(found)[0]["fy"] == fy != 0.0


def test_a_branch_of_a_path(tmp_path):
    text = """[analysis]
kind = "path"
points = 6
direction = -1
start = { bifurcation = 1, until = 2.5, newton = { iterations = 20 } }
"""
    column = ARM + LIFT.replace("[0, 100]", "[-200, 0]")
    found = from_file(tmp_path / "a.toml", column + text).solution
    model = held(beam := arm(), [bf.PointForce(beam.end, (-200, 0))])
    path = bf.trace_equilibrium(model, 2.5, newton=bf.Newton(iterations=20))
    require_same(found, bf.trace_equilibrium(model, start=path.bifurcations[0], points=6, direction=-1))
    with pytest.raises(ModelFileError, match="start is at the bifurcation 3, but its path has 1"):
        from_file(tmp_path / "a.toml", column + text.replace("bifurcation = 1", "bifurcation = 3"))


FRAME = """
[frames.portal]
file = "portal.msh"
elements = { columns = 1, beam = 2 }
element = { columns = { kind = "CRBF", order = 3 }, beam = "ANCFCRBF" }
section = { columns = { kind = "circle", diameter = 0.1 }, beam = { kind = "rectangle", width = 0.1, height = 0.1 } }
material = { youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7800.0 }
members = "chains"
hinges = "corners"
[[supports]]
kind = "clamp"
points = "portal.feet"
[[loads]]
kind = "distributed"
beams = "portal.beam"
vector = [0, -500]
[[loads]]
kind = "force"
point = "portal.at(3, 4)"
vector = [100, 0]
[[outputs]]
point = "portal[2].at(0.5)"
quantities = ["uy"]
"""


@pytest.fixture
def portal(tmp_path):
    """Return a place for a model file beside the mesh of a portal."""
    copyfile(MESHES / "portal.msh", tmp_path / "portal.msh")
    return tmp_path / "a.toml"


def portal_in_python():
    """Return the frame of FRAME and its model."""
    elements, kinds = {"columns": 1, "beam": 2}, {"columns": bf.CRBF(3), "beam": bf.ANCFCRBF()}
    sections = {"columns": bf.Circle(0.1), "beam": bf.Rectangle(0.1, 0.1)}
    mesh = bf.read_mesh(MESHES / "portal.msh")
    frame = mesh.frame(elements, kinds, sections, STEEL, members="chains", hinges="corners")
    loads = [bf.DistributedLoad(beam, (0, -500)) for beam in frame.members("beam")]
    loads.append(bf.PointForce(frame.at(3, 4), (100, 0)))
    return frame, bf.Model(frame.beams, [bf.Clamp(point) for point in frame.points("feet")], loads, frame.joints)


def test_a_frame_from_a_mesh_file(portal):
    portal.write_text(FRAME)
    job = read_model_file(portal)
    found = job.solve()
    frame, model = portal_in_python()
    expected = bf.solve_static(model)
    require_same(found.solution, expected)
    assert list(job.beams) == [f"portal[{number + 1}]" for number in range(len(frame.beams))]
    assert job.outputs[0].rows(found.solution)[0]["uy"] == expected.displacement(frame.beams[1].at(0.5))[-1, 1]


def test_points_of_a_crooked_frame(portal):
    point = FRAME.replace("portal[2].at(0.5)", "portal.at(6, 4)")
    portal.write_text(point + '[imperfection]\nsize = 0.02\nof = "modes"\n')
    job = read_model_file(portal).imperfect()
    found = job.solve()
    _, model = portal_in_python()
    expected = bf.solve_static(model.with_imperfection(bf.solve_modes(model, 1), 0.02))
    require_same(found.solution, expected)
    uy = job.outputs[0].rows(found.solution)[0]["uy"]
    assert uy == pytest.approx(expected.displacement(expected.model.joints[-1].a)[-1, 1], rel=1e-9)


def test_supports_may_share_a_table(tmp_path):
    pins = '[[supports]]\nkind = "pin"\npoints = ["arm.at(0.5)", "arm.end"]\n'
    load = '[[loads]]\nkind = "pressure"\nbeams = ["arm"]\nvalue = 500.0\n'
    found = from_file(tmp_path / "a.toml", ARM + pins + load).solution
    beam = arm()
    supports = [bf.Clamp(beam.start), bf.Pin(beam.at(0.5)), bf.Pin(beam.end)]
    require_same(found, bf.solve_static(bf.Model([beam], supports, [bf.Pressure(beam, 500.0)])))


# what is added to ARM and LIFT, or replaced in FRAME; the key and words of the error
MISTAKES = {
    "no field": ("element", '{ kind = "Element", coordinates = "rotation", forces = "structural" }', "", "field is mi"),
    "unknown field": (
        "element",
        '{ kind = "Element", field = "cubical", coordinates = "rotation", forces = "structural" }',
        ".field",
        "did you mean cubic",
    ),
    "unknown coordinates": (
        "element",
        '{ kind = "Element", field = "cubic", coordinates = "rotations", forces = "structural" }',
        ".coordinates",
        "did you mean rotation",
    ),
    "odd combination": (
        "element",
        '{ kind = "Element", field = "lagrange", coordinates = "shear-free", forces = "structural" }',
        ".coordinates",
        "has no r_x",
    ),
    "odd key of a field": (
        "element",
        '{ kind = "Element", field = { kind = "cubic", order = 3 }, coordinates = "rotation", forces = "structural" }',
        ".field.order",
        "unknown key",
    ),
    "odd mesh": ("elements", '{ kind = "grade", elements = 3, ratio = 2 }', ".kind", "did you mean graded"),
    "odd ratio": ("elements", '{ kind = "graded", elements = 3, ratio = 0 }', ".ratio", "greater than zero"),
    "mesh of truth": ("elements", "true", "", "got true"),
    "thickness of words": (
        "section",
        '{ kind = "layered", width = 1, layers = [{ material = "steel", thickness = "thin" }] }',
        ".layers[1].thickness",
        "the file has none",
    ),
    "thickness that ends": (
        "section",
        '{ kind = "layered", width = 0.1, layers = [{ material = "steel", thickness = { kind = "table", points = '
        "[[0, 0.01], [1, -0.01]] } }] }",
        "",
        "thickness of Layer must be greater than zero",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_in_a_beam_is_named(case, tmp_path):
    key, value, within, words = MISTAKES[case]
    lines = [f"{key} = {value}" if line.startswith(f"{key} = ") else line for line in ARM.splitlines()]
    require_refused(tmp_path / "a.toml", "\n".join(lines), f"beams.arm.{key}{within}", words)


def require_refused(file, text, key, words):
    """Fail where a text is not refused at a key in these words."""
    file.write_text(text)
    with pytest.raises(ModelFileError) as caught:
        read_model_file(file)
    assert caught.value.key == key, str(caught.value)
    assert words in caught.value.message
    assert caught.value.line is not None


ANALYSES = {
    'kind = "static"\nat = [0.5, 0.25]': ("at", "rise within 0 and 1"),
    'kind = "static"\nat = 0.5': ("at", "must be a list"),
    'kind = "modes"\nabout = 1.5': ("about", "within 0 and 1"),
    'kind = "modes"\nabout = "statics"': ("about", '"reference" or "static"'),
    'kind = "modes"\nabout = { factor = 1.0 }': ("about.factor", "did you mean load_factor"),
    'kind = "modes"\nabout = { load_factor = 1, snap = "jum" }': ("about.snap", "jump"),
    'kind = "modes"\nabout = { file = "none.h5" }': ("about.file", "there is no file"),
    'kind = "modes"\nabout = "static"\nloaded = true': ("about", "loaded are given"),
    'kind = "modes"\nframes = 1': ("frames", "at least 2"),
    'kind = "modes"\namplitude = 0': ("amplitude", "greater than zero"),
    'kind = "path"\nstart = "static"': ("start", "must be a table"),
    'kind = "path"\nstart = { bifurcation = 0 }': ("start.bifurcation", "at least 1"),
    'kind = "path"\nstart = { bifurcation = 1, util = 1 }': ("start.util", "did you mean until"),
    'kind = "path"\nstep = 0.1\nstart = { bifurcation = 1 }': ("step", "finds its own"),
    'kind = "path"\ndirection = 2': ("direction", "1 or -1"),
}


@pytest.mark.parametrize("text", ANALYSES)
def test_a_mistake_in_an_analysis_is_named(text, tmp_path):
    key, words = ANALYSES[text]
    require_refused(tmp_path / "a.toml", ARM + LIFT + "[analysis]\n" + text, f"analysis.{key}", words)


FRAMES = {
    "portal.msh": ("portle.msh", "frames.portal.file", "there is no file"),
    "columns = 1": ("colums = 1", "frames.portal.elements", "did you mean columns"),
    "columns = { kind": ("columns = { kid", "frames.portal.element.columns", "kind is missing"),
    '"chains"': ('"chain"', "frames.portal.members", "chains"),
    'hinges = "corners"': ('hinges = "corner"', "frames.portal.hinges", "did you mean corners"),
    "portal.feet": ("portal.feets", "supports[1].points", "did you mean feet"),
    "portal.beam": ("prtal.beam", "loads[1].beams", "did you mean portal"),
    '"portal.beam"': ('"portal"', "loads[1].beams", "FRAME.SET"),
    "at(3, 4)": ("at(3, 5)", "loads[2].point", "the nearest end is at (3, 4)"),
    "(3, 4)": ("(3)", "loads[2].point", "two numbers"),
    "portal[2]": ("portal[9]", "outputs[1].point", "there is no beam"),
    'points = "portal.feet"': ('point = "portal.at(0, 0)"\npoints = "portal.feet"', "supports[1].points", "one of th"),
}


@pytest.mark.parametrize("old", FRAMES)
def test_a_mistake_in_a_frame_is_named(old, portal):
    new, key, words = FRAMES[old]
    assert old in FRAME
    require_refused(portal, FRAME.replace(old, new, 1), key, words)
