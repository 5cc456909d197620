"""Messages of the library in the keys of model files: where they name Python, a phrase of TOML takes its place."""

import math
import re
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from beamfem import errors
from beamfem.errors import BeamfemError

# longer phrases before those that they contain
_PHRASES = (
    ("trace_equilibrium follows the path around it", '`kind = "path"` in [analysis] follows the path around it'),
    ('snap="jump" goes', '`snap = "jump"` beside `kind = "static"` goes'),
    ('unstable="leave" follows', '`unstable = "leave"` beside `kind = "static"` follows'),
    ("prescribe a displacement (Prescribed)", 'prescribe a displacement (`kind = "prescribed"` in [[supports]])'),
    ("use a Prescribed support with", 'use a support of kind "prescribed" with'),
    ("start from what solve_static finds with this support", 'take `start = "static"` with this support'),
    ("add a PointForce of (0, 0)", 'add a load of kind "force" with `vector = [0, 0]`'),
    ("let a Prescribed support move", 'let a support of kind "prescribed" move'),
    ("add a Rigid or a Hinge", 'add one to [[joints]], of kind "rigid" or "hinge"'),
    (
        "supports that hold it (a Clamp, or a Pin and a Roller) or joints that stiffen it (Rigid instead of Hinge); "
        "without them, use simulate",
        '[[supports]] that hold it (`kind = "clamp"`, or a "pin" and a "roller") or [[joints]] that stiffen it '
        '(`kind = "rigid"` instead of "hinge"); without them, use `kind = "dynamics"` in [analysis]',
    ),
    (
        "solution.stable tells which; trace_equilibrium finds the bifurcations and follows their branches",
        'The quantity "stable" in [[outputs]] tells which; `kind = "path"` in [analysis] finds the bifurcations, and '
        "its `start` follows their branches",
    ),
    (
        "Give about= a state of solve_static with the same loads",
        'Give `about = "static"` in [analysis], the equilibrium under the same loads',
    ),
    (
        "the growth of solve_modes(model, about=state)",
        'the growth that `kind = "modes"` in [analysis] prints, about a state that `about` gives,',
    ),
    ("add one with scale=True", "add one to [[loads]] without `scale = false`"),
    ("take it from solve_static", 'take it from `kind = "static"`'),
    (
        "import that module before loading the file",
        'name its Python file, or one that imports it, at the top of the model file: code = "FILE.py"',
    ),
    ("give one of solve_static", 'give one of `kind = "static"`'),
    ("at of solve_static must be", "at must be"),
    ("as those returned by solve_buckling", 'as those of `kind = "buckling"`'),
    ("such as one RigidVelocity", "such as `velocity = { vector = [0, 0], angular = 1 }`"),
    (
        "velocity must be a RigidVelocity or a function",
        "velocity must be a table with vector and angular, or a function",
    ),
    (
        "integrator must be a GeneralizedAlpha(rho_inf=...), an object with rule(step) as it has, or one with "
        "step(motion, begin, end)",
        "integrator must be left out, or be a class with rule(step) or step(motion, begin, end)",
    ),
    ("as Piecewise does", 'as those of kind "table" and "piecewise" do'),
    ("newton must be a Newton(tolerance=..., iterations=...)", "newton must be a table with tolerance and iterations"),
    ("residual_tolerance of Newton", "residual_tolerance of newton"),
    ("such as path.bifurcations[0]", "such as `{ bifurcation = 1 }`"),
    (
        "two inclined Rollers stand at the same point; a Pin constrains",
        'two inclined supports of kind "roller" stand at the same point; one of kind "pin" constrains',
    ),
    ("an inclined Roller stands", 'an inclined support of kind "roller" stands'),
    ("Prescribed at ", 'the support of kind "prescribed" at '),
    (
        "coefficient of thermal expansion, Material(..., thermal_expansion=1.2e-5)",
        "coefficient of thermal expansion, `thermal_expansion = 1.2e-5`",
    ),
    ("give a material its strength, Material(..., strength=)", "give a material its `strength`"),
    ("Section(..., height=) gives it", "their key `height` gives it"),
    ("needs Structural() or ElasticLine() forces", 'needs an element with `forces = "structural"` or "elastic-line"'),
    (
        "needs Structural forces, such as CRBF(order=2) or ANCF(Structural())",
        'needs structural forces, such as `{ kind = "CRBF", order = 2 }` or `{ kind = "ANCF", forces = "structural" }`',
    ),
    (
        "use CRBF(order=3), ANCF(Structural()), ANCFCRBF(Structural()) or, without shear at the nodes, "
        'ShearRigid(stretchable=False, integration="reduced")',
        'use `{ kind = "CRBF", order = 3 }`, "ANCF" or "ANCFCRBF" with `forces = "structural"` or, without shear at '
        'the nodes, `{ kind = "ShearRigid", stretchable = false, integration = "reduced" }`',
    ),
    (
        "use Structural or ElasticLine forces, or a Section with a material",
        'use `forces = "structural"` or "elastic-line", or a section of kind "moments" with a material',
    ),
    ("or Structural forces", 'or `forces = "structural"`'),
    ('elements="knots" needs a BSpline as curve', '`elements = "knots"` needs a curve of kind "bspline"'),
    ("a cubic element such as ANCF()", 'a cubic element such as "ANCF"'),
    ('integration="lobatto" is', '`integration = "lobatto"` is'),
    (
        "a cubic close to it goes through positions and tangents at arc lengths s: "
        "spline_through_hermite(s, curve.position(s), curve.tangent(s))",
        'a cubic close to it is a curve of kind "hermite"',
    ),
    ("give Beam one", "give the beam one"),
    (
        "Give section and material to mesh.frame(...), supports and loads to Model(...)",
        "Give section and material in [frames.NAME], supports and loads in [[supports]] and [[loads]]",
    ),
)
# where a message is none of these
_NAMES = {
    "solve_static": '`kind = "static"`',
    "trace_equilibrium": '`kind = "path"`',
    "solve_buckling": '`kind = "buckling"`',
    "solve_modes": '`kind = "modes"`',
    "simulate": '`kind = "dynamics"`',
}
_NAME = re.compile(r"\b(" + "|".join(_NAMES) + r")\b")
_RADIANS = re.compile(r"np\.radians\(([^()]+)\)")
_ARGUMENT = re.compile(r"\b(save_every)=(?=\d)")


def in_keys(message: str) -> str:
    """Return a message of the library as a user of model files reads it."""
    for python, toml in _PHRASES:
        message = message.replace(python, toml)
    message = _RADIANS.sub(lambda match: f"{math.radians(float(match[1])):.12g}", message)
    return _ARGUMENT.sub(r"\1 = ", _NAME.sub(lambda match: _NAMES[match[0]], message))


@contextmanager
def warned_in_keys() -> Iterator[None]:
    """Tell warnings of the library in the keys of model files, without lines of Python."""
    with warnings.catch_warnings():
        others = warnings.showwarning

        def show(message: Any, category: Any, *place: Any) -> None:
            if category.__module__ == errors.__name__ or category is UserWarning:
                print(f"warning: {in_keys(str(message))}", file=sys.stderr)
            else:
                others(message, category, *place)

        warnings.showwarning = show  # type: ignore[assignment]
        yield


@contextmanager
def told_in_keys() -> Iterator[None]:
    """Let what fails say so in the keys of model files, and its warnings too."""
    try:
        with warned_in_keys():
            yield
    except BeamfemError as error:
        error.args = tuple(in_keys(part) if isinstance(part, str) else part for part in error.args)
        raise
