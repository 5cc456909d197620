"""Planar beams that bend far: a field, nodal coordinates and elastic forces, each an exchangeable part."""

from beamfem.analysis.buckling import Buckling, solve_buckling
from beamfem.analysis.dynamics import simulate
from beamfem.analysis.initial import RigidVelocity
from beamfem.analysis.integrators import GeneralizedAlpha
from beamfem.analysis.modes import Modes, solve_modes
from beamfem.analysis.newton import Newton
from beamfem.analysis.statics import solve_static
from beamfem.convergence.study import converge
from beamfem.curves import Line
from beamfem.element.element import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, Element, ShearRigid
from beamfem.element.forces import ContinuumMechanics, ElasticLine, SplitContinuum, Structural
from beamfem.errors import BeamfemError, ConvergenceError, FreeMotionError, InputError, UnknownPointError
from beamfem.io.results import load
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.joints import Hinge, Rigid
from beamfem.model.loads import DistributedLoad, Gravity, PointForce, PointMoment
from beamfem.model.model import Model
from beamfem.model.supports import Clamp, Foundation, Pin, Prescribed, Roller, Spring
from beamfem.postprocess import Fields, SectionForces
from beamfem.section import Circle, Layer, Layered, Rectangle, Section, Tube
from beamfem.solution import Solution, State
from beamfem.sweep import sweep

__all__ = [
    "ANCF",
    "ANCFCRBF",
    "CRBF",
    "Beam",
    "BeamfemError",
    "BilinearANCF",
    "BilinearCRBF",
    "Circle",
    "Buckling",
    "Clamp",
    "ContinuumMechanics",
    "ConvergenceError",
    "DistributedLoad",
    "ElasticLine",
    "Element",
    "Fields",
    "Foundation",
    "FreeMotionError",
    "GeneralizedAlpha",
    "Gravity",
    "Hinge",
    "InputError",
    "Layer",
    "Layered",
    "Line",
    "Material",
    "Model",
    "Modes",
    "Newton",
    "Pin",
    "Point",
    "PointForce",
    "PointMoment",
    "Prescribed",
    "Rectangle",
    "Rigid",
    "RigidVelocity",
    "Roller",
    "Section",
    "SectionForces",
    "ShearRigid",
    "Solution",
    "SplitContinuum",
    "Spring",
    "State",
    "Structural",
    "Tube",
    "UnknownPointError",
    "converge",
    "load",
    "simulate",
    "solve_buckling",
    "solve_modes",
    "solve_static",
    "sweep",
]
