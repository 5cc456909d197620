"""Mistakes of those who write their first model file: what the message says would be right."""

import tomllib

import pytest

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
    ],
    ids=["an element without its order", "a kind of section", "a place of a beam", "no table", "a key given twice"],
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
        ('file = "C:\\x"', "paths may be written with /"),
        ('kind = "pin\npoint = "a.end"', "a quotation mark is missing"),
    ],
)
def test_errors_of_syntax_say_what_would_be_right(text, hint):
    with pytest.raises(tomllib.TOMLDecodeError) as caught:
        tomllib.loads(text)
    assert hint in in_words(str(caught.value), text).partition("; ")[2]


@pytest.mark.parametrize("text", ["", "=", "a = [1, 2", "\n\n[a", "a = -", "a =", "a = [\n\n"])
def test_other_errors_of_syntax_are_left_as_they_are(text):
    message = "no error"
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
    assert in_words(message, text) == message
