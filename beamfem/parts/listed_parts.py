"""Supports, joints, loads and connectors of the package, one a line: public, kinds of model files, saved by name.

Messages list kinds in this order.
"""

# ruff: isort: off
from beamfem.parts.clamp import Clamp as Clamp
from beamfem.parts.pin import Pin as Pin
from beamfem.parts.roller import Roller as Roller
from beamfem.parts.prescribed import Prescribed as Prescribed
from beamfem.parts.spring import Spring as Spring
from beamfem.parts.foundation import Foundation as Foundation
from beamfem.parts.rigid import Rigid as Rigid
from beamfem.parts.hinge import Hinge as Hinge
from beamfem.parts.link import Link as Link
from beamfem.parts.slider import Slider as Slider
from beamfem.parts.weld import Weld as Weld
from beamfem.parts.gear import Gear as Gear
from beamfem.parts.cable import Cable as Cable
from beamfem.parts.bushing import Bushing as Bushing
from beamfem.parts.drag import Drag as Drag
from beamfem.parts.spring_damper import SpringDamper as SpringDamper
from beamfem.parts.stop import Stop as Stop
from beamfem.parts.hinge_friction import HingeFriction as HingeFriction
from beamfem.parts.hinge_stop import HingeStop as HingeStop
from beamfem.parts.torsion_spring import TorsionSpring as TorsionSpring
from beamfem.parts.point_mass import PointMass as PointMass
from beamfem.parts.rigid_body import RigidBody as RigidBody
from beamfem.parts.gravity import Gravity as Gravity
from beamfem.parts.point_force import PointForce as PointForce
from beamfem.parts.point_moment import PointMoment as PointMoment
from beamfem.parts.distributed_load import DistributedLoad as DistributedLoad
from beamfem.parts.pressure import Pressure as Pressure
from beamfem.parts.actuation import Actuation as Actuation
from beamfem.parts.temperature import Temperature as Temperature
from beamfem.parts.motor import Motor as Motor
from beamfem.parts.moving_force import MovingForce as MovingForce
