"""With BEAMFEM_CHECK=1 a kernel that leaves an array ends with an error; without it no check is compiled."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import out_of_bounds
import pytest

from beamfem.kernels.compiler import machine
from beamfem.kernels.compiler.bounds_checks import CHECKED

SCRIPT = Path(__file__).parents[1] / "out_of_bounds.py"
BEYOND = {
    "write 10": "write, line {}: values, index 10, of an array of size 10",
    "write -1": "write, line {}: values, index -1, of an array of size 10",
    f"write {2**61}": f"write, line {{}}: values, index {2**61}, of an array of size 10",
    "step -5": "write_after_a_step, line {}: later, index -5, of an array of size 10, first index -4",
    "step 6": "write_after_a_step, line {}: later, index 6, of an array of size 10, first index -4",
    "inlined 12": "set_entry, line {}: entries, index 12, of an array of size 10",
    "lanes 3": "read_lanes, line {}: lanes, index 3, of an array of size 10",
    "stack 3": "read_stack, line {}: own, index 3, of an array of size 3",
    "address 4": "read_address, line {}: short, index 4, of an array of size 4",
    "null": "read_address, line {}: short, index 0, of an array of size 0",
    "call 2": "write, line {}: values, index 2, of an array of size 2",
    "drawer 1 3": "read_drawer, line {}: numbers, index 3, of an array of size 3",
    "drawer 2 0": "read_drawer, line {}: drawer, index 1, of an array of size 4, first index -4",
    "divide 0": "divide, line {}: integer division by zero",
    "whole nan": "whole, line {}: int of NaN or a number too large",
    "whole 1e+19": "whole, line {}: int of NaN or a number too large",
}
INSIDE = (
    "write 0",
    "write 9",
    "step -4",
    "step 5",
    "inlined 9",
    "lanes 2",
    "stack 2",
    "address 3",
    "call 1",
    "drawer 1 2",
    "divide 2",
)


def run(checked, folder, code=None):
    environment = os.environ | {"BEAMFEM_CACHE_DIR": str(folder), "BEAMFEM_CHECK": checked}
    command = [sys.executable, *(["-c", code] if code else [str(SCRIPT)])]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("code")


@pytest.fixture(scope="module")
def ends(folder):
    return json.loads(run("1", folder))


def test_a_write_out_of_bounds_is_caught(ends):
    """The error names kernel, line, array, index and size, and nothing is written."""
    lines = SCRIPT.read_text().splitlines()
    for case, text in BEYOND.items():
        error, values = ends[case]
        kernel = text.split(",")[0]
        number = int(error.split("line ")[1].split(":")[0])
        assert error == f"__main__.{text.format(number)}"
        above = [line for line in lines[:number] if line.startswith("def ")]
        assert above[-1].startswith(f"def {kernel}(")
        assert not any(values), case
    assert "values, address 0x" in ends["odd"][0]
    assert "is not a multiple of 8 bytes" in ends["odd"][0]


def test_what_is_inside_is_not_refused(ends):
    assert not [ends[case][0] for case in INSIDE if isinstance(ends[case][0], str)]
    assert (ends["lanes 2"], ends["stack 2"][0]) == ([5.0, [0.0] * 2 + [1.0] * 8], 7.0)
    assert ends["call 1"][1][1] == 3.0
    assert ends["whole 2.5"][1][0] == 2.0


@pytest.mark.slow
def test_a_solve_with_checks_gives_the_same_numbers(ends):
    assert np.allclose(ends["solved"][1], out_of_bounds.solved(), rtol=1e-12, atol=0.0)


def test_code_with_checks_is_cached_apart(ends, folder):
    code = "import beamfem.kernels.cache as c; print(c.cache_folder())"
    with_checks, without = (Path(run(checked, folder, code).strip()) for checked in ("1", ""))
    assert with_checks.parent == without.parent
    assert with_checks != without
    assert any(with_checks.glob("*.code"))
    assert not any(without.glob("*.code"))


@pytest.mark.skipif(CHECKED, reason="needs code without checks")
def test_without_the_variable_no_check_is_compiled():
    module = str(out_of_bounds.write.module())
    assert module.count("getelementptr") == 2
    assert "call" not in module
    assert "checked" not in machine.description()
