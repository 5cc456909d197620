"""Curves: stress-free shapes of the beam axis."""

from beamfem.curves.bspline import BSpline
from beamfem.curves.chain import Chain
from beamfem.curves.curve import Curve
from beamfem.curves.lines_and_arcs import Arc, Line, Polyline
from beamfem.curves.parametric import Parametric
from beamfem.curves.splines import elliptic_arc, spline_through_hermite, without_removable_knots
