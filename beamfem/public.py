"""What users see of the package, and where it is: `beamfem` gets it from here when it is first asked for."""

from beamfem import view as view  # offers plot() and the like on results, and imports what draws at the first call
from beamfem.assembly.rigid_velocity import RigidVelocity
from beamfem.convergence.result import Convergence as _Convergence
from beamfem.convergence.study import converge
from beamfem.curves import (
    Arc,
    BSpline,
    Chain,
    Curve,
    Line,
    Parametric,
    Polyline,
    elliptic_arc,
    spline_through_hermite,
    without_removable_knots,
)
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.element import Element
from beamfem.element.fields import Cubic, Lagrange
from beamfem.element.forces import ContinuumMechanics, ElasticLine, SplitContinuum, Structural
from beamfem.element.presets import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, ShearRigid
from beamfem.errors import (
    BeamfemError,
    ChangedCodeWarning,
    ConvergenceError,
    FileError,
    FreeMotionError,
    InputError,
    LimitPointError,
    MissingPackageError,
    NotJoinedWarning,
    NotReadWarning,
    NotStoredWarning,
    RoundOffWarning,
    SeveralTurnsWarning,
    UnknownPointError,
    UnknownStressWarning,
    UnstableWarning,
)
from beamfem.io.cad import read_dxf
from beamfem.io.frame import Frame
from beamfem.io.mesh import LineMesh, read_mesh
from beamfem.io.results import load
from beamfem.keywords import check_classes as _check_classes
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.body_load import BodyLoad
from beamfem.model.contribution import At, Contribution, Remembering
from beamfem.model.grading import graded
from beamfem.model.imposed_strain import ImposedStrain
from beamfem.model.imposed_strains import Actuation, Temperature
from beamfem.model.joints import Hinge, Joint, Rigid
from beamfem.model.line_load import LineLoad
from beamfem.model.loads import DistributedLoad, Gravity, PointForce, PointMoment, Pressure
from beamfem.model.model import Model
from beamfem.model.point_load import PointLoad
from beamfem.model.support import LineSupport, PointSupport
from beamfem.model.supports import Clamp, Foundation, Pin, Prescribed, Roller, Spring
from beamfem.model.time_functions import Interpolated, Piecewise
from beamfem.results.beam_stress import BeamStress
from beamfem.results.on_basis import FieldOnBasis, field_on_basis
from beamfem.results.path import Bifurcation, Path, PathState
from beamfem.results.postprocess import Fields, SectionForces
from beamfem.results.solution import Solution, State
from beamfem.results.status import Status
from beamfem.section import Circle, Layer, Layered, Rectangle, RememberingLaw, Section, SectionLaw, Tube
from beamfem.solve.modes.modes import Modes, solve_modes
from beamfem.solve.motion.dynamics import simulate
from beamfem.solve.motion.integrators import GeneralizedAlpha, Scheme
from beamfem.solve.motion.own_step import EquationsOfMotion, Integrator
from beamfem.solve.newton.iteration import Newton
from beamfem.solve.paths.trace import trace_equilibrium
from beamfem.solve.stability.buckling import Buckling, solve_buckling
from beamfem.solve.statics.statics import solve_static
from beamfem.sweeps.sweep import Sweep as _Sweep
from beamfem.sweeps.sweep import sweep

_check_classes(list(vars().values()))
