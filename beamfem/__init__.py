"""Planar beams that bend far: a field, nodal coordinates and elastic forces, each an exchangeable part."""

from beamfem.analysis.dynamics import simulate
from beamfem.analysis.initial import RigidVelocity
from beamfem.analysis.integrators import GeneralizedAlpha
from beamfem.analysis.newton import Newton
from beamfem.analysis.statics import solve_static
from beamfem.convergence.study import converge
from beamfem.curves import Line
from beamfem.element.element import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, Element
from beamfem.element.forces import ContinuumMechanics, Structural
from beamfem.errors import BeamfemError, ConvergenceError, FreeMotionError, InputError, UnknownPointError
from beamfem.io.results import load
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.loads import DistributedLoad, Gravity, PointForce, PointMoment
from beamfem.model.model import Model
from beamfem.model.supports import Clamp, Pin, Prescribed, Roller
from beamfem.postprocess import Fields, SectionForces
from beamfem.section import Rectangle, Section
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
    "Clamp",
    "ContinuumMechanics",
    "ConvergenceError",
    "DistributedLoad",
    "Element",
    "Fields",
    "FreeMotionError",
    "GeneralizedAlpha",
    "Gravity",
    "InputError",
    "Line",
    "Material",
    "Model",
    "Newton",
    "Pin",
    "Point",
    "PointForce",
    "PointMoment",
    "Prescribed",
    "Rectangle",
    "RigidVelocity",
    "Roller",
    "Section",
    "SectionForces",
    "Solution",
    "State",
    "Structural",
    "UnknownPointError",
    "converge",
    "load",
    "simulate",
    "solve_static",
    "sweep",
]
