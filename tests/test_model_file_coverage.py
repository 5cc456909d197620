"""Everything public is in model files: each name and parameter is a key, or here with the reason why it is none."""

import inspect
import typing
from collections.abc import Callable
from importlib import import_module

import pytest
from model_file_pairs import ARM

import beamfem as bf
from beamfem import registry
from beamfem.cli.modelfile import (
    actions,
    analyses,
    axes,
    beams,
    elements,
    files,
    frames,
    functions,
    parts,
    read,
    read_model_file,
)
from beamfem.cli.modelfile.curves import OutputCurve
from beamfem.cli.modelfile.drawing import from_drawing
from beamfem.cli.modelfile.imperfection import Imperfection
from beamfem.cli.modelfile.outputs import Output
from beamfem.cli.modelfile.starts import _saved

# what is public and made by `build` itself: all its parameters are keys
ITSELF = {
    *(make for kinds in (parts.SECTIONS, axes.CURVES, axes.MESHES, functions.FUNCTIONS) for make in kinds.values()),
    *(make for kinds in (elements.ELEMENTS, elements.FIELDS, elements.COORDINATES) for make in kinds.values()),
    *(make for kinds in (actions.SUPPORTS, actions.LOADS, actions.JOINTS) for make in kinds.values()),
    bf.Material,
    bf.Layer,
    bf.Newton,
    bf.RigidVelocity,
}

KEYS = dict.fromkeys(read._KEYS)
# what is public: what of a model file takes its parameters, as a callable or as keys
BY = {
    bf.Cubic: elements.FIELDS["cubic"],
    bf.ContinuumMechanics: elements.FORCES["continuum"],
    bf.SplitContinuum: elements.FORCES["split-continuum"],
    bf.ElasticLine: elements.FORCES["elastic-line"],
    bf.Structural: elements.FORCES["structural"],
    bf.Beam: beams.called("NAME"),
    bf.Model: KEYS,
    bf.Model.with_imperfection: Imperfection,
    bf.Model.plot: files.Undeformed,
    bf.Point: dict.fromkeys(("beam", "fraction")),  # in a text, "NAME.at(0.5)"
    bf.read_dxf: from_drawing,
    bf.read_mesh: frames._of_file,
    bf.LineMesh.frame: frames._of_file,
    bf.load: _saved,
    bf.solve_static: analyses.Static,
    bf.trace_equilibrium: analyses.Trace,
    bf.solve_buckling: analyses.Buckling,
    bf.Buckling.solution: analyses.Buckling,
    bf.Buckling.plot: files.Shapes,
    bf.solve_modes: analyses.Modes,
    bf.Modes.solution: analyses.Modes,
    bf.Modes.plot: files.Shapes,
    bf.simulate: analyses.Dynamics,
    bf.GeneralizedAlpha: analyses.Dynamics,
    bf.sweep: KEYS,
    bf.Solution.position: Output,
    bf.Solution.displacement: Output,
    bf.Solution.velocity: Output,
    bf.Solution.rotation: Output,
    bf.Solution.fields: Output,
    bf.Solution.reaction: Output,
    bf.Solution.connector_force: Output,
    bf.Solution.multipliers: Output,
    bf.Solution.section_forces: Output,
    bf.Solution.stresses: Output,
    bf.Solution.energy: Output,
    bf.Solution.linear_momentum: Output,
    bf.Solution.angular_momentum: Output,
    bf.Solution.stable: Output,
    bf.Solution.to_vtk: files.Vtk,
    bf.Solution.to_html: files.Page,
    bf.Solution.plot: files.Plot,
    bf.Solution.plot_history: files.History,
    bf.Solution.plot_load_displacement: files.LoadDisplacement,
    bf.Solution.plot_curve: OutputCurve,
    bf.Solution.animate: files.Film,
    bf.Solution.picture: files.Body,
    bf.Solution.save: files.Results,
}
# keys of another name
NAMED = {
    (bf.Model.with_imperfection, "modes"): "of",
    (bf.Solution.plot_history, "point"): "points",
}
# what is no key, and why: a name, or a parameter of one
NO_KEY = {
    (bf.Beam, "name"): "the NAME of [beams.NAME]",
    (bf.sweep, "function"): "the function of a sweep is the file itself",
    (bf.sweep, "executor"): "points are solved one after the other, in the process of the command",
    (bf.sweep, "store"): "the command writes the table with --out; who keeps results for years has a script",
    (bf.sweep, "keep_stale"): "as `store`",
    (bf.sweep, "parameters"): "[[sweep]] with key and values",
    "At": "what a connector is given; connectors are Python beside the file",
    "Contribution": "what connectors have in common; [connectors.NAME] takes any class",
    "Remembering": "as Contribution",
    **dict.fromkeys(
        ("BodyLoad", "ImposedStrain", "LineLoad", "PointLoad", "LineSupport", "PointSupport", "Joint"),
        "what loads, supports or joints have in common; [[loads]], [[supports]] and [[joints]] take any class",
    ),
    "Curve": "what curves have in common",
    "Integrator": "what integrators have in common; [analysis] integrator takes any class",
    "Scheme": "as Integrator",
    "EquationsOfMotion": "what an integrator is given",
    "RememberingLaw": "as SectionLaw",
    "SectionLaw": "what sections with a law have in common; [sections.NAME] takes any class",
    "BeamStress": "a result, of which outputs ask",
    "Bifurcation": "a result; [analysis] start counts them",
    "Buckling": "a result",
    "FieldOnBasis": "a result for programs that use scikit-fem",
    "Fields": "a result, of which outputs ask",
    "Frame": "what [frames.NAME] makes",
    "LineMesh": "what [frames.NAME] reads; nodes and lines as numbers are a program's",
    "Modes": "a result",
    "Path": "a result",
    "PathState": "a result",
    "SectionForces": "a result, of which outputs ask",
    "Solution": "a result",
    "State": "a result",
    "Status": "how a solve ended, which the command tells by its exit code and its statistics",
    "converge": "a study of many meshes for a program; [[sweep]] over elements gives its table",
    "field_on_basis": "for programs that use scikit-fem",
    "without_removable_knots": "gives the same curve",
    "Solution.spline": "a curve for a program to go on with",
    "Solution.to_pandas": "arrays for a program to go on with",
    "Solution.to_xarray": "arrays for a program to go on with",
    "Solution.peak_stress": "outputs ask for the stresses of each beam",
    "Solution.show": "a window, which waits for its user",
    "Solution.support_forces": "numbers by coordinate, which only a program can place; outputs ask for reactions",
    "Solution.remainders": "digits that only a program can use",
    "Solution.warnings": "printed after every solve",
    "Solution.status": "as Status",
    "Solution.iterations": "printed after every solve",
    "Solution.energy_drift": "printed as a warning where it matters",
    "Solution.time": "printed beside what outputs ask for",
    "Solution.load_factor": "printed beside what outputs ask for",
    "Modes.to_pandas": "printed, and with --json for programs",
    "Modes.to_xarray": "arrays for a program to go on with",
    "Buckling.to_xarray": "arrays for a program to go on with",
    "Modes.elastic": "numbers that the printed table has",
    "Modes.status": "as Status",
    "Modes.warnings": "printed after every solve",
    "Buckling.to_pandas": "printed, and with --json for programs",
    "Model.unit": "a name of a unit for a program",
    "Model.meshes": "numbers of the mesh for a program",
    "Model.coordinates": "printed after every solve",
    "Model.size": "printed after every solve",
    "Model.groups": "numbers of the mesh for a program",
    "Model.number_of": "numbers of the mesh for a program",
    "Model.mesh_of": "numbers of the mesh for a program",
    "Model.numbered": "numbers of the mesh for a program",
    "Model.nodes_needed": "numbers of the mesh for a program",
    "Model.tables": "tables of solvers, for a program",
    "Model.imposed_on": "numbers of the mesh for a program",
    "Solution.computed": "keeps functions of a program",
    "Model.with_loads": "loops over loads belong in Python",
    "Model.with_": "loops over loads belong in Python",
    "Model.supports_along": "numbers of the mesh for a program",
    **dict.fromkeys(
        (
            f"Model.{name}"
            for name in (
                *("gravity", "line_loads", "imposing"),
                *("point_loads", "point_supports", "line_supports"),
            )
        ),
        "parts of what the file has",
    ),
}


def public() -> dict[str, object]:
    """Return what is public by name: classes, functions, and methods of models and results."""
    found = {name: getattr(bf, name) for name in bf.__all__}
    found = {name: item for name, item in found.items() if not (inspect.isclass(item) and issubclass(item, Exception))}
    for kind in (bf.Model, bf.Solution, bf.Modes, bf.Buckling, bf.LineMesh):
        parts = {name: item for base in kind.__mro__[-2::-1] for name, item in vars(base).items()}
        own = {name: item for name, item in parts.items() if name[0] != "_" and name not in kind.__annotations__}
        found |= {f"{kind.__name__}.{name}": item for name, item in own.items()}
    return found


def parameters(item: object) -> dict[str, inspect.Parameter]:
    """Return what a public function or method takes, that of an upper room where it does the work."""
    if (declared := inspect.unwrap(item)) in registry._FUNCTIONS:
        module, name = registry._FUNCTIONS[declared].split(":")
        return dict(list(inspect.signature(getattr(import_module(module), name)).parameters.items())[1:])
    return dict(inspect.signature(item).parameters)


PUBLIC = public()


@pytest.mark.parametrize("name", PUBLIC)
def test_what_is_public_has_its_keys(name):
    item = PUBLIC[name]
    by = item if callable(item) and item in ITSELF else BY.get(item)
    assert (by is not None) != (name in NO_KEY), f"{name}: make it part of model files, or give the reason in NO_KEY"
    if by is None or not callable(item):
        return
    taken = by if isinstance(by, dict) else inspect.signature(by).parameters
    for parameter in parameters(item):
        if parameter in ("self", "model") or (parameter == "path" and "file" in taken):
            continue  # the model is that of the file
        key = NAMED.get((item, parameter), parameter)
        known = key in taken or (item, parameter) in NO_KEY
        assert known, f"{name}({parameter}=...): make it a key of {by}, or give the reason in NO_KEY"


def test_reasons_are_of_what_there_is():
    assert {name for name in NO_KEY if isinstance(name, str)} <= set(PUBLIC)
    for item, parameter in (*(key for key in NO_KEY if isinstance(key, tuple)), *NAMED):
        assert parameter in parameters(item)
    assert set(map(id, BY)) <= set(map(id, PUBLIC.values())) | {id(bf.Solution.stable)}


WHOLE = {
    "prescribed": 'point = "arm.end"',
    "gravity": "vector = [0, -9.81]",
    "force": 'point = "arm.end"\nvector = [0, 1]',
    "moment": 'point = "arm.end"\nmoment = 1',
    "distributed": 'beam = "arm"\nvector = [0, 1]',
    "pressure": 'beam = "arm"\nvalue = 1',
    "actuation": 'beam = "arm"\ncurvature = 1',
    "temperature": 'beam = "arm"\nchange = 1',
}
FUNCTIONS_OF = [
    (kind, name)
    for kind, make in {**actions.SUPPORTS, **actions.LOADS}.items()
    for name, hint in typing.get_type_hints(make).items()
    if any(typing.get_origin(part) is Callable for part in (hint, *typing.get_args(hint)))
]


@pytest.mark.parametrize(("kind", "name"), FUNCTIONS_OF)
def test_where_python_takes_a_function_a_file_does(kind, name, tmp_path):
    lines = [line for line in WHOLE[kind].splitlines() if not line.startswith(f"{name} =")]
    course = '{ kind = "sine", frequency = 2 }'
    lines.append(f"{name} = [0, {course}]" if name == "vector" else f"{name} = {course}")
    table = "supports" if kind in actions.SUPPORTS else "loads"
    text = ARM.replace("density", "thermal_expansion = 1e-5\ndensity") + f'[[{table}]]\nkind = "{kind}"\n'
    (tmp_path / "a.toml").write_text(text + "\n".join(lines))
    value = getattr(getattr(read_model_file(tmp_path / "a.toml").model, table)[-1], name)
    assert value(0.125)[1] if name == "vector" else value(0.125) == pytest.approx(1.0)
