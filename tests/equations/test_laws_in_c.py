"""Section laws that are C functions, called by their address: the results of the same laws in Python."""

import shutil
import subprocess
from ctypes import CDLL, c_void_p, cast
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from history_laws import Plastic
from slow_values import mostly_slow

import beamfem as bf
from beamfem.errors import InputError
from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import given
from beamfem.testing import check_law

SOURCE = """
#include <math.h>
void plastic(const double *e, const double *h, double dt, const double *d, double *s, double *t) {
    double trial = d[2] * (e[2] - h[0]) - d[4] * h[0], over = fabs(trial) - d[3];
    double flow = over > 1e-9 * d[3] ? copysign(over, trial) / (d[2] + d[4]) : 0.0;
    s[0] = d[0] * e[0]; s[1] = d[1] * e[1]; s[2] = d[2] * (e[2] - h[0] - flow);
    if (t) {
        for (int i = 0; i < 9; i++) t[i] = 0.0;
        t[0] = d[0]; t[4] = d[1]; t[8] = flow != 0.0 ? d[2] * d[4] / (d[2] + d[4]) : d[2];
    }
}
"""


@routine("rrdrrr")
def plastic(e, h, dt, d, s, t):
    trial = d[2] * (e[2] - h[0]) - d[4] * h[0]
    over = abs(trial) - d[3]
    flow = over / (d[2] + d[4]) if over > 1e-9 * d[3] else 0.0
    flow = flow if trial > 0.0 else -flow
    s[0], s[1], s[2] = d[0] * e[0], d[1] * e[1], d[2] * (e[2] - h[0] - flow)
    if given(t):
        for i in range(9):
            t[i] = 0.0
        t[0], t[4], t[8] = d[0], d[1], d[2] * d[4] / (d[2] + d[4]) if flow != 0.0 else d[2]


@cache
def address(how, folder):
    if how == "llvm":
        return plastic.address
    if not (compiler := shutil.which("cc")):
        pytest.skip("no C compiler")
    (folder / "law.c").write_text(SOURCE)
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", folder / "law.so", folder / "law.c", "-lm"], check=True)
    return cast(CDLL(str(folder / "law.so")).plastic, c_void_p).value


@dataclass(frozen=True)
class InC(Plastic):
    place: int = 0

    def compiled(self, material):
        return self.place, (self.axial, self.shear, self.bending, self.limit, self.hardening)


NUMBERS = {"axial": 2e6, "shear": 8e5, "bending": 60.0, "mass": 0.3, "rotary_inertia": 1e-5}


def bent(section, element, analysis):
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 6, element, section, bf.Material(2e11, 0.3, 7850.0))
    swing = bf.PointMoment(bar.end, 12.0, amplitude=lambda at: np.sin(5 * at), scale=False)
    load = bf.PointForce(bar.end, (-30.0, 0.0), amplitude=lambda at: at, scale=False)
    model = bf.Model([bar], [bf.Clamp(bar.start)], [swing, load])
    result = bf.solve_static(model, steps=12) if analysis == "static" else bf.simulate(model, 0.05, step=1e-3)
    return result.displacement(bar.end), result.energy().recorded


@pytest.mark.parametrize("how", ["llvm", "c"])
@pytest.mark.parametrize("analysis", ["static", "motion"])
@mostly_slow("element", [bf.CRBF(order=3), bf.ANCF(bf.Structural())], ids=["CRBF", "ANCF"])
def test_a_law_in_c_gives_the_results_of_the_same_law_in_python(how, analysis, element, tmp_path):
    numbers = {**NUMBERS, "limit": 6.0 if analysis == "static" else 0.5, "hardening": 20.0}
    moved, lost = bent(InC(**numbers, place=address(how, tmp_path)), element, analysis)
    expected, dissipated = bent(Plastic(**numbers), element, analysis)
    assert dissipated[-1] > 0.0
    np.testing.assert_allclose(moved, expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(lost, dissipated, rtol=1e-8, atol=1e-12)


def test_what_is_no_address_is_refused():
    with pytest.raises(InputError, match="compiled of InC must return the address of a C function"):
        bent(InC(**NUMBERS, limit=6.0, hardening=20.0), bf.CRBF(order=3), "static")


def test_check_law_compares_it_with_the_law_in_python():
    section = InC(**NUMBERS, limit=6.0, hardening=20.0, place=plastic.address)
    check_law(section)

    class Other(InC):
        def compiled(self, material):
            return self.place, (self.axial, self.shear, 1.01 * self.bending, self.limit, self.hardening)

    with pytest.raises(AssertionError, match="is not that of its resultants"):
        check_law(Other(**NUMBERS, limit=6.0, hardening=20.0, place=plastic.address))
