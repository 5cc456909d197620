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

    Model             Model Beam Point Material Rayleigh KelvinVoigt graded RotatingFrame
    Axes              Line Arc Polyline Chain BSpline Parametric Curve
                      elliptic_arc spline_through_hermite without_removable_knots
    Sections          Rectangle Circle Tube Polygon Profile Section Layered Layer SectionLaw
                      Fibres ElasticPlastic RambergOsgood Maxwell
    Elements          ANCF CRBF ANCFCRBF BilinearANCF BilinearCRBF ShearRigid Element
    Element parts     Cubic Lagrange Gradients Rotation ShearFree
                      ContinuumMechanics SplitContinuum ElasticLine Structural
    Supports          Clamp Pin Roller Spring Foundation Prescribed
    Joints            Rigid Hinge
    Masses, springs   PointMass RigidBody SpringDamper TorsionSpring Bushing Cable
                      Link Slider SliderOnBeam Weld Gear Drag Stop HingeFriction HingeStop SliderStop StateForce
    Loads             PointForce PointMoment DistributedLoad Pressure Gravity Actuation Temperature
                      Pretension Motor MovingForce
    Time functions    Interpolated Piecewise
    To files          write_abaqus write_opensees
    From files        read_mesh LineMesh Frame read_abaqus_model AbaqusModel read_dxf load
    Solvers           solve_static trace_equilibrium solve_buckling solve_modes simulate resume
                      linearise frequency_response reduce
    Solver settings   Newton RigidVelocity Event
    Integrators       GeneralizedAlpha HHT Newmark Trapezoidal Midpoint Gauss Radau EnergyMomentum
                      Bathe CentralDifferences DormandPrince
    Results           Solution State Path PathState Bifurcation Modes Buckling Status
                      LinearModel FrequencyResponse MotionState Occurrence
    Along beams       SectionForces BeamStress envelope Envelope Fields FieldOnBasis field_on_basis
    Studies           sweep converge
    User-defined      PointLoad LineLoad BodyLoad ImposedStrain PointSupport LineSupport Joint
                      Contribution At PartAtPoints PartAlongBeam Connection Remembering RememberingLaw
                      FibreLaw FibreLawWithHistory
                      Scheme Integrator EquationsOfMotion
    Errors            BeamfemError InputError UnknownPointError FreeMotionError ConvergenceError
                      LimitPointError FileError MissingPackageError
    Warnings          UnstableWarning RoundOffWarning LockingWarning LargeStrainWarning CuspWarning EnergyWarning
                      TimeStepWarning CoarseMeshWarning LongRunWarning
                      UnitsWarning SeveralTurnsWarning UnknownStressWarning
                      NotJoinedWarning NotReadWarning NotWrittenWarning NotStoredWarning ChangedCodeWarning
"""

from importlib.metadata import version as _version
from typing import Any as _Any

import lazy_loader as _lazy_loader

# the public names are those of the stub `__init__.pyi`; each is imported at its first use
_imported, __dir__, __all__ = _lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> _Any:
    """Import a public name; errors about arguments of a class then start with its name, not with `__init__`."""
    value = _imported(name)
    if isinstance(value, type):
        for maker in (value.__init__, value.__new__):
            if getattr(maker, "__qualname__", "").startswith(f"{name}.") and hasattr(maker, "__code__"):
                maker.__qualname__ = name
    return value


__version__ = _version("beamfem")
