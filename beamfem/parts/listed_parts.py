"""Supports, joints, loads and connectors of the package, one a line: public, kinds of model files, saved by name.

Messages list kinds in this order.
"""

# ruff: isort: off
from beamfem.model.supports import Clamp as Clamp
from beamfem.model.supports import Pin as Pin
from beamfem.model.supports import Roller as Roller
from beamfem.model.supports import Prescribed as Prescribed
from beamfem.model.supports import Spring as Spring
from beamfem.model.supports import Foundation as Foundation
from beamfem.model.joints import Rigid as Rigid
from beamfem.model.joints import Hinge as Hinge
from beamfem.parts.link import Link as Link
from beamfem.parts.drag import Drag as Drag
from beamfem.parts.spring_damper import SpringDamper as SpringDamper
from beamfem.parts.torsion_spring import TorsionSpring as TorsionSpring
from beamfem.parts.point_mass import PointMass as PointMass
from beamfem.parts.point_mass import RigidBody as RigidBody
from beamfem.model.loads import Gravity as Gravity
from beamfem.model.loads import PointForce as PointForce
from beamfem.model.loads import PointMoment as PointMoment
from beamfem.model.loads import DistributedLoad as DistributedLoad
from beamfem.model.loads import Pressure as Pressure
from beamfem.model.imposed_strains import Actuation as Actuation
from beamfem.model.imposed_strains import Temperature as Temperature
