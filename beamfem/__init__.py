"""Planar beams that bend far: a field, nodal coordinates and elastic forces, each an exchangeable part."""

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from beamfem.public import *

__all__ = [
    "ANCF",
    "ANCFCRBF",
    "CRBF",
    "Actuation",
    "Arc",
    "At",
    "BSpline",
    "Beam",
    "BeamfemError",
    "Bifurcation",
    "BilinearANCF",
    "BilinearCRBF",
    "Buckling",
    "Chain",
    "ChangedCodeWarning",
    "Circle",
    "Clamp",
    "ContinuumMechanics",
    "Contribution",
    "ConvergenceError",
    "Cubic",
    "Curve",
    "DistributedLoad",
    "ElasticLine",
    "Element",
    "EquationsOfMotion",
    "FieldOnBasis",
    "Fields",
    "FileError",
    "Foundation",
    "Frame",
    "FreeMotionError",
    "GeneralizedAlpha",
    "Gradients",
    "Gravity",
    "Hinge",
    "InputError",
    "Integrator",
    "Interpolated",
    "Lagrange",
    "Layer",
    "Layered",
    "LimitPointError",
    "Line",
    "LineMesh",
    "Material",
    "Model",
    "Modes",
    "Newton",
    "NotJoinedWarning",
    "NotStoredWarning",
    "Parametric",
    "Path",
    "PathState",
    "Piecewise",
    "Pin",
    "Point",
    "PointForce",
    "PointMoment",
    "Polyline",
    "Prescribed",
    "Pressure",
    "Rectangle",
    "Remembering",
    "Rigid",
    "RigidVelocity",
    "Roller",
    "Rotation",
    "RoundOffWarning",
    "Section",
    "SectionForces",
    "SectionLaw",
    "ShearFree",
    "ShearRigid",
    "Solution",
    "SplitContinuum",
    "Spring",
    "State",
    "Status",
    "Structural",
    "Temperature",
    "Tube",
    "UnknownPointError",
    "UnknownStressWarning",
    "UnstableWarning",
    "converge",
    "elliptic_arc",
    "field_on_basis",
    "graded",
    "load",
    "read_dxf",
    "read_mesh",
    "simulate",
    "solve_buckling",
    "solve_modes",
    "solve_static",
    "spline_through_hermite",
    "sweep",
    "trace_equilibrium",
    "without_removable_knots",
]


def __getattr__(name: str) -> Any:
    """Return what is public, imported at the first call: a second or so, which no import of the package pays."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name, obj=sys.modules[__name__])
    public = import_module("beamfem.public")
    globals().update({each: getattr(public, each) for each in __all__})
    return globals()[name]


def __dir__() -> list[str]:
    return [*__all__]
