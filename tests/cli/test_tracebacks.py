"""Errors are shown at the lines of the user, without those of the package."""

import re
import subprocess
import sys
import traceback

import pytest

import beamfem as bf

MODEL = """import beamfem as bf

steel = bf.Material(2e11, 0.3, 7800.0)


def section(s):
    return bf.Rectangle(0.1, 0.1 - s)


def model(section):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, section=section, material=steel)
    return bf.Model([beam])


"""


@pytest.mark.parametrize(
    ("line", "lines", "message"),
    [
        ("bf.Rectangle(0.1, -1)", ["<module>"], "InputError: height of Rectangle"),
        ("bf.solve_static(model(bf.Rectangle(0.1, 0.1)))", ["<module>"], "FreeMotionError: beam 0 can move freely"),
        ("model(section)", ["section", "<module>", "model"], r"InputError: section\(0.5\) cannot be computed"),
        ("1 / 0", ["<module>"], "ZeroDivisionError"),
    ],
)
def test_a_script_shows_its_own_lines_only(line, lines, message, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(MODEL + line)
    said = subprocess.run([sys.executable, str(script)], capture_output=True, text=True).stderr
    assert re.findall(r'File ".*script.py", line \d+, in (.*)', said) == lines
    assert said.count("File ") == len(lines)
    assert re.search(message, said.splitlines()[-1])


def test_a_notebook_shows_its_own_lines_only():
    with pytest.raises(bf.InputError) as caught:
        bf.Rectangle(0.1, -1.0)
    assert len(traceback.extract_tb(caught.value.__traceback__)) > 1
    shown = "".join(caught.value._render_traceback_())
    assert re.findall(r", in (.*)", shown) == ["test_a_notebook_shows_its_own_lines_only"]
