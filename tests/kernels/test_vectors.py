"""Passes over rows of points run several at a time: losing that is silent, so the machine code is looked at."""

import platform
import re

import pytest

from beamfem.kernels import element_stiffness as stiffness
from beamfem.kernels import field, linear_law
from beamfem.kernels import inertia_forces as inertia
from beamfem.kernels.band import band
from beamfem.kernels.bidirectional_lu import bidirectional_lu
from beamfem.kernels.compiler.machine import assembly_code
from beamfem.physics.compiled_elements import MEASURE_PASSES

green_lagrange, structural, elastic_line = MEASURE_PASSES
PASSES = [
    *(stiffness.columns, stiffness.combine, stiffness.products, inertia.add_inertia, inertia.add_mass),
    *(field.interpolate, field.distribute, linear_law.four_resultants, linear_law.six_resultants),
    *(forces[name] for forces in (green_lagrange, structural) for name in ("strains", "forces", "rates")),
    *(forces["hessian"] for forces in (green_lagrange, structural)),
    *(band(half_width).factor for half_width in (5, 8, 11)),
    *(bidirectional_lu(half_width, short=False).solve for half_width in (5, 8, 11)),
]
PACKED = {
    "x86_64": r"\bv?(?:{})(?:\d+)?pd\b",
    "AMD64": r"\bv?(?:{})(?:\d+)?pd\b",
    "aarch64": r"\bf(?:{})\s+v\d+\.2d",
    "arm64": r"\bf(?:{})\.2d",
}
pytestmark = pytest.mark.skipif(platform.machine() not in PACKED, reason="instructions of this processor are not known")


def packed(routine, operations):
    """How many packed instructions of some operations there are in a pass, compiled anew."""
    return len(re.findall(PACKED[platform.machine()].format(operations), assembly_code(routine.module())))


@pytest.mark.parametrize("routine", PASSES, ids=lambda routine: routine.name.removeprefix("beamfem.kernels."))
def test_products_of_a_pass_are_packed(routine):
    assert packed(routine, "mul|fmadd|fmsub|fnmadd|mla|mls")


def test_divisions_and_roots_of_a_pass_are_packed():
    for forces in (structural, elastic_line):
        for name in ("strains", "forces", "rates", "hessian"):
            routine = forces[name]
            assert packed(routine, "div"), routine.name
    assert packed(structural["strains"], "sqrt")


def test_a_loop_that_cannot_be_packed_is_told_apart():
    """What the other tests look for is not in every machine code."""
    assert not packed(band(3).solve_lower, "div")
