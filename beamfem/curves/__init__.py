"""Curves: stress-free shapes of the beam axis."""

from beamfem.curves.arc import Arc
from beamfem.curves.bspline import BSpline
from beamfem.curves.chain import Chain
from beamfem.curves.curve import Curve
from beamfem.curves.line import Line
from beamfem.curves.parametric import Parametric
from beamfem.curves.polyline import Polyline
from beamfem.curves.splines import elliptic_arc, spline_through_hermite, without_removable_knots
