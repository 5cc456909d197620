"""Mistakes of those who write their first model file: what the message says would be right."""

import tomllib

import pytest
from typer.testing import CliRunner

from beamfem.cli.app import app
from beamfem.cli.modelfile.errors import ModelFileError
from beamfem.cli.modelfile.read import read_model_file
from beamfem.cli.modelfile.toml_faults import in_words

GOOD = """title = "An arm"
[materials.steel]
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[sections.square]
kind = "rectangle"
width = 0.01
height = 0.01
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 6
element = { kind = "CRBF", order = 3 }
section = "square"
material = "steel"
[[supports]]
kind = "clamp"
point = "arm.start"
"""


def said(tmp_path, old, new):
    assert old in GOOD
    (tmp_path / "arm.toml").write_text(GOOD.replace(old, new, 1))
    with pytest.raises(ModelFileError) as caught:
        read_model_file(tmp_path / "arm.toml")
    return str(caught.value).removeprefix(f"{tmp_path}/")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            '{ kind = "CRBF", order = 3 }',
            '"CRBF"',
            "arm.toml:13: beams.arm.element: the kind 'CRBF' needs further keys: { kind = \"CRBF\", order = ... }",
        ),
        (
            'section = "square"',
            'section = "rectangle"',
            "arm.toml:14: beams.arm.section: the kind 'rectangle' needs further keys: "
            '{ kind = "rectangle", width = ..., height = ... }',
        ),
        (
            '"arm.start"',
            '"arm.begin"',
            'arm.toml:18: supports[1].point: must be a point such as "arm.start", "arm.end" or "arm.at(0.5)", got '
            '"arm.begin"',
        ),
        (
            'title = "An arm"',
            'analysis = "static"',
            'arm.toml:1: analysis: must be a table, headed [analysis], got the text "static"',
        ),
        (
            "density = 7800.0",
            "density = 7800.0\ndensity = 7850.0\n",
            "arm.toml:6: not valid TOML: Cannot overwrite a value (at line 6, column 17); "
            "the key density is there twice",
        ),
        (
            'element = { kind = "CRBF", order = 3 }',
            "element = 3",
            "arm.toml:13: beams.arm.element: must be the name of an element, or a table, got 3",
        ),
        (
            'curve = { kind = "line", start = [0, 0], end = [1, 0] }',
            'curve = "line"',
            'arm.toml:11: beams.arm.curve: must be a table: { kind = "line", start = ..., end = ... }',
        ),
        (
            'title = "An arm"',
            'units = ["N", "mm"]',
            "arm.toml:1: units: must be a text, got the array ['N', 'mm']",
        ),
        (
            "[[supports]]",
            '[[loads]]\nkind = "gravity"\nvector = [0, -1]\namplitude = "ramp"\n[[supports]]',
            "arm.toml:19: loads[1].amplitude: there is no function 'ramp'; the file has none; they are headed "
            "[functions.NAME]",
        ),
        (
            "[[supports]]",
            '[[sweep]]\nkey = "beam.arm.elements"\nvalues = [2]\n[[supports]]',
            "arm.toml:17: sweep[1].key: beam.arm.elements is not in the file; did you mean beams.arm.elements? "
            "Otherwise write it there with one of its values",
        ),
        (
            "[[supports]]",
            '[[sweep]]\nkey = "supports[0].point"\nvalues = ["arm.end"]\n[[supports]]',
            'arm.toml:17: sweep[1].key: must be a key such as "sections.NAME.height" or "loads[1].vector[2]", with '
            'items counted from 1, got "supports[0].point"',
        ),
    ],
    ids=[
        *("an element without its order", "a kind of section", "a place of a beam", "no table", "a key given twice"),
        *("an element of a number", "a kind of curve", "units in a list", "a function that is not there"),
        *("a key to vary that is misspelt", "a key to vary counted from 0"),
    ],
)
def test_messages_of_a_model_file(tmp_path, old, new, message):
    assert said(tmp_path, old, new) == message


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("point = arm.start", 'texts are written in quotation marks: "arm.start"'),
        ("follower = True", "write true"),
        ("width = .5", "numbers begin with a digit: 0.5"),
        ("width = 5.", "numbers are written like 5.0"),
        ("vector = (0, 1)", "arrays are written in square brackets: [0, 1]"),
        ("width = 1/3", "only a comment may follow a value on its line"),
        ("width: 1", "keys and their values are written: key = value"),
        ('curve = { kind = "line",\n start = [0, 0] }', "a table in braces must be on one line"),
        ("[beams.arm]\na = 1\n[beams.arm]\nb = 1", "only those in double brackets, such as [[loads]], may be repeated"),
        ("[loads]\na = 1\n[[loads]]\nb = 1", "above, its header has another number of brackets"),
        ("[beams.Träger]", "others are written in quotation marks"),
        ('file = "C:\\x"', "paths may be written with /"),
        ('kind = "pin\npoint = "a.end"', "a quotation mark is missing"),
    ],
)
def test_errors_of_syntax_say_what_would_be_right(text, hint):
    with pytest.raises(tomllib.TOMLDecodeError) as caught:
        tomllib.loads(text)
    assert hint in in_words(str(caught.value), text).partition("; ")[2]


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (b"\x89HDF\r\n", "this is a results file, which beamfem info, plot and export read; model files are TOML"),
        (b"\xff\xfe", "this is not a text in UTF-8; model files are TOML"),
    ],
)
def test_other_files_are_named(tmp_path, start, message):
    (tmp_path / "arm.h5").write_bytes(start)
    with pytest.raises(ModelFileError) as caught:
        read_model_file(tmp_path / "arm.h5")
    assert str(caught.value) == f"{tmp_path / 'arm.h5'}: {message}"


@pytest.mark.filterwarnings("default::beamfem.errors.SeveralTurnsWarning")
def test_an_arc_in_degrees_is_warned_of_in_numbers(tmp_path):
    line, arc = "end = [1, 0]", 'kind = "arc", center = [0, 0], radius = 1, start_angle = 0, end_angle = 180'
    (tmp_path / "arm.toml").write_text(GOOD.replace('kind = "line", start = [0, 0], ' + line, arc))
    done = CliRunner().invoke(app, ["run", str(tmp_path / "arm.toml"), "--quiet"])
    assert done.exit_code == 0
    (said,) = done.stderr.splitlines()
    assert said.startswith("warning: the arc turns by 180 rad, more than one full turn; angles are in radians")
    assert said.endswith("for 180 degrees give 3.14159265359")


@pytest.mark.parametrize("text", ["", "=", "a = [1, 2", "\n\n[a", "a = -", "a =", "a = [\n\n"])
def test_other_errors_of_syntax_are_left_as_they_are(text):
    message = "no error"
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
    assert in_words(message, text) == message
