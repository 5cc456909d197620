"""Equations and kernels ask parts for what they add, and know none of them by its name."""

import ast
from pathlib import Path

import pytest

import beamfem as bf

ROOT = Path(bf.__file__).parent
BASES = ROOT / "parts" / "at_points.py"
FILES = sorted(path for folder in ("equations", "kernels") for path in (ROOT / folder).rglob("*.py"))


def names_of_parts():
    trees = (ast.parse(path.read_text()) for path in (ROOT / "parts").glob("*.py") if path != BASES)
    return {each.name for tree in trees for each in tree.body if isinstance(each, ast.ClassDef)}


def words_of(tree):
    """Names and texts of the code, without docstrings."""
    docs = {id(each.value) for each in ast.walk(tree) if isinstance(each, ast.Expr)}
    for node in ast.walk(tree):
        for field in ("id", "attr", "name", "asname", "module"):
            yield from str(getattr(node, field, "")).split(".")
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield from "".join(letter if letter.isalpha() else " " for letter in node.value).split()


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_it_names_no_part(path):
    words, names = set(words_of(ast.parse(path.read_text()))), names_of_parts()
    assert len(names) > 25
    assert not words & (names | {f"{name}s" for name in names}), path
