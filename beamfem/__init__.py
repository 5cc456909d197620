"""Finite elements for planar beams under large deflections.

A field, nodal coordinates and elastic forces make an element, and each of the three can be exchanged. Any consistent
set of units works; the docstrings state SI units, shapes of arrays in parentheses, and [-] for numbers without a unit.
"Paper" is the paper cited in the README.

Examples
--------
The examples of all docstrings continue this one, a steel cantilever with a force across its end:

>>> import beamfem as bf
>>> import numpy as np
>>> steel = bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
>>> beam = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), steel)
>>> model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0.0, -1e4))])
>>> solution = bf.solve_static(model)
>>> round(float(solution.displacement(beam.end)[-1, 1]), 4)
-0.0305

Contents; see help(bf.Beam), for example, for details.
"""

import sys
from typing import TYPE_CHECKING, Any

from beamfem.whole import imports_all, whole_package

if TYPE_CHECKING:
    from beamfem.public import *

    __version__: str

# what is public, by theme; where it is: in `beamfem.public`
_CONTENTS = {
    "Model": "Model Beam Point Material graded",
    "Axes": (
        "Line Arc Polyline Chain BSpline Parametric Curve\nelliptic_arc spline_through_hermite without_removable_knots"
    ),
    "Sections": "Rectangle Circle Tube Section Layered Layer SectionLaw",
    "Elements": "ANCF CRBF ANCFCRBF BilinearANCF BilinearCRBF ShearRigid Element",
    "Element parts": (
        "Cubic Lagrange Gradients Rotation ShearFree\nContinuumMechanics SplitContinuum ElasticLine Structural"
    ),
    "Supports": "Clamp Pin Roller Spring Foundation Prescribed",
    "Joints": "Rigid Hinge",
    "Loads": "PointForce PointMoment DistributedLoad Pressure Gravity Actuation Temperature",
    "Time functions": "Interpolated Piecewise",
    "From files": "read_mesh LineMesh Frame read_dxf load",
    "Solvers": "solve_static trace_equilibrium solve_buckling solve_modes simulate",
    "Solver settings": "Newton GeneralizedAlpha RigidVelocity",
    "Results": "Solution State Path PathState Bifurcation Modes Buckling Status",
    "Along beams": "SectionForces BeamStress Fields FieldOnBasis field_on_basis",
    "Studies": "sweep converge",
    "User-defined": (
        "PointLoad LineLoad BodyLoad ImposedStrain PointSupport LineSupport Joint\n"
        "Contribution At Remembering RememberingLaw Scheme Integrator EquationsOfMotion"
    ),
    "Errors": (
        "BeamfemError InputError UnknownPointError FreeMotionError ConvergenceError\n"
        "LimitPointError FileError MissingPackageError"
    ),
    "Warnings": (
        "UnstableWarning RoundOffWarning LockingWarning LargeStrainWarning EnergyWarning TimeStepWarning\n"
        "UnitsWarning SeveralTurnsWarning UnknownStressWarning\n"
        "NotJoinedWarning NotReadWarning NotStoredWarning ChangedCodeWarning"
    ),
}
__all__ = [name for names in _CONTENTS.values() for name in names.split()]
__doc__ = f"{__doc__ or ''}\n" + "".join(
    f"    {theme if number == 0 else '':<18}{line}\n"
    for theme, names in _CONTENTS.items()
    for number, line in enumerate(names.split("\n"))
)

imports_all("beamfem.public")


def __getattr__(name: str) -> Any:
    """Return what is public, imported at the first call: a second or so, which no import of the package pays."""
    if name == "__version__":
        from importlib.metadata import version

        return version("beamfem")
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name, obj=sys.modules[__name__])
    public = whole_package()
    globals().update({key: getattr(public, key) for key in __all__})
    return globals()[name]


def __dir__() -> list[str]:
    """Return what is public; nothing to help(), which has it by theme above, and would add 6000 lines on all of it."""
    frame = sys._getframe(1) if "pydoc" in sys.modules else None
    while frame is not None:
        if frame.f_globals.get("__name__") == "pydoc":
            return []
        frame = frame.f_back
    return [*__all__]
