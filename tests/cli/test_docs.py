"""Every code block of README and docs runs, prints what the page shows, and what pages name exists."""

import ast
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

import beamfem as bf
from docs.page_code import blocks_of, run

# pages that explain locking show elements that lock
pytestmark = pytest.mark.filterwarnings("error::beamfem.LargeStrainWarning")
ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
SWEEPS = ROOT / "docs" / "howto" / "convergence_and_sweeps.md"  # starts processes many times
LISTED = [pytest.param(page, marks=pytest.mark.slow if page == SWEEPS else ()) for page in PAGES]
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")
_TINY = 1e-8  # two numbers below this are round-off of zero


def same(shown: str, printed: str) -> bool:
    """Whether texts agree; numbers are rounded to the digits shown, and "..." stands for anything."""
    shown, printed = " ".join(shown.split()), " ".join(printed.split())
    pattern, numbers = "", []
    for part in re.split(r"(\.\.\.)", shown):
        if part == "...":
            pattern += ".*"
            continue
        last = 0
        for number in _NUMBER.finditer(part):
            pattern += re.sub(r"(\\ )+", " *", re.escape(part[last : number.start()])) + f"({_NUMBER.pattern})"
            numbers.append(number[0])
            last = number.end()
        pattern += re.sub(r"(\\ )+", " *", re.escape(part[last:]))
    match = re.fullmatch(pattern, printed)
    return match is not None and all(_close(*pair) for pair in zip(numbers, match.groups(), strict=True))


def _close(shown: str, printed: str) -> bool:
    mantissa, _, exponent = shown.partition("e")
    digits = mantissa.partition(".")[2]
    if "." not in mantissa and not exponent:
        return shown == printed
    a, b = float(shown), float(printed)
    # NumPy leaves zeros out: "2." stands for more digits than it shows
    unit = 10.0 ** (int(exponent or 0) - len(digits)) if digits or exponent else 1e-4 * abs(a)
    return abs(a - b) <= 0.5001 * unit or max(abs(a), abs(b)) < _TINY


@pytest.mark.parametrize("page", LISTED, ids=lambda page: str(page.relative_to(ROOT)))
def test_code_of_a_page_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    for block, printed in run(page, page.read_text()):
        if block.output is not None:
            assert same(block.output, printed), f"{page}, line {block.line}: it prints\n{printed}"


def test_a_result_with_the_form_load_of_the_page_is_saved(tmp_path, monkeypatch):
    """Once its class stands in a module, as in a script."""
    page = ROOT / "docs" / "extending" / "connectors.md"
    module = ModuleType("page")
    monkeypatch.setitem(sys.modules, "page", module)
    for block in blocks_of(page.read_text()):
        exec(block.code, module.__dict__)
        if "class Water" in block.code:
            break
    module.bent.save(tmp_path / "gate.h5")
    loaded = bf.load(tmp_path / "gate.h5")
    assert isinstance(loaded.model.connectors[0], module.Water)
    again = bf.solve_static(loaded.model).position(loaded.model.beams[0].end)[-1]
    assert again == pytest.approx(module.bent.position(module.gate.end)[-1], rel=1e-9)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_names_exists(page):
    text = page.read_text()
    for name in re.findall(r"\bbf\.(\w+)", text):
        assert hasattr(bf, name), f"bf.{name}"
    for path in re.findall(r"`((?:beamfem|studies|tests|docs)/[\w/.]*)`", text):
        assert (ROOT / path).exists(), path
    for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
        drawn = re.fullmatch(r"/_pictures/(drawings/\w+)\.png", link)  # by the build
        assert (ROOT / "docs" / f"{drawn[1]}.py" if drawn else page.parent / link).exists(), link


def test_cards_of_the_start_page_show_pictures_of_the_pages_to_which_they_lead():
    cards = re.findall(
        r":img-top: /_pictures/([\w/]+)/(\w+\.\w+)\n.*\n:link: ([\w/]+)\.html(?:#(\S+))?\n",
        (ROOT / "docs/index.md").read_text(),
    )
    assert len(cards) >= 16
    for folder, picture, page, heading in cards:
        text = (ROOT / "docs" / f"{page}.md").read_text()
        headings = [re.sub(r"[^\w -]", "", line).lower() for line in re.findall(r"^##+ (.*)$", text, re.M)]
        assert not heading or heading in [line.replace(" ", "-") for line in headings], heading
        code = "".join(path.read_text() for path in (ROOT / "examples").glob("*.py")) if page == "examples" else text
        assert page == folder
        assert re.search(rf'"out/(examples/)?{picture}"', code), picture


def test_lengths_of_the_parts_in_extending_are_those_of_their_code():
    page = ROOT / "docs" / "extending.md"
    place = r"(?:`(tests/[\w/]+\.py)`|\[\w+\]\(([\w/]+\.md)#[^|]*)"
    rows = re.findall(rf"^\| [^|]* \| `(\w+)` \| {place} \| (\d+) \|$", page.read_text(), re.M)
    assert len(rows) == 16
    for name, file, other, lines in rows:
        text = (ROOT / file).read_text() if file else (page.parent / other).read_text()
        code = text if file else "\n".join(block.code for block in blocks_of(text))
        parts = [part for part in ast.parse(code).body if getattr(part, "name", "") == name]
        assert [part.end_lineno - part.lineno + 1 for part in parts] == [int(lines)], name


def test_lengths_of_parts_in_the_package_are_those_of_their_code():
    rows = re.findall(
        r"^\| [^|]* \| `(\w+)` \| (\d+) \| \d files, ", (ROOT / "docs" / "extending.md").read_text(), re.M
    )
    tree = ast.parse((ROOT / "tests" / "trial_parts.py").read_text())
    lengths = {part.name: part.end_lineno - part.lineno + 1 for part in tree.body if isinstance(part, ast.ClassDef)}
    assert {name: int(lines) for name, lines in rows} == lengths


def test_lengths_of_the_bushing_are_those_of_its_code():
    """Lines of its class, and of its definition without docstrings."""
    page = (ROOT / "docs" / "extending.md").read_text()
    lengths = re.search(r"`beamfem/parts/bushing.py`, (\d+) lines.*?: (\d+) in", page, re.S).groups()
    for file, start, length in zip(
        ("parts/bushing", "physics/connections"), ("class ", "def _bush|_?BUSHING"), lengths, strict=True
    ):
        code = ast.parse((ROOT / "beamfem" / f"{file}.py").read_text()).body
        found = [part for part in code if re.search(rf"^({start})", ast.unparse(part), re.M)]
        lines = sum(part.end_lineno - part.lineno + 1 for part in found)
        documented = [part for part in found if isinstance(part, ast.FunctionDef) and ast.get_docstring(part)]
        assert lines - len(documented) == int(length), file


def test_lines_that_know_a_part_by_name_are_counted():
    """Lines outside the class and docstrings; the docstring of the package is the list of names."""
    page = (ROOT / "docs" / "extending.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \|.* (\d+) lines, (\d+) files \|$", page, re.M)
    assert len(rows) == 5
    sources = [path for kind in ("py", "pyi") for path in (ROOT / "beamfem").rglob(f"*.{kind}")]
    for name, lines, files in rows:
        found = [_lines_with(name, path) for path in sources]
        assert (sum(found), sum(map(bool, found))) == (int(lines), int(files)), name


def _lines_with(name: str, path: Path) -> int:
    source = path.read_text()
    if not re.search(rf"\b{name}\b", source):
        return 0
    left_out, own = set(), (ast.Module, ast.ClassDef, ast.FunctionDef)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ClassDef) and node.name == name:
            left_out |= set(range(node.lineno, node.end_lineno + 1))
        elif isinstance(node, own) and ast.get_docstring(node) and path != ROOT / "beamfem" / "__init__.py":
            left_out |= set(range(node.body[0].lineno, node.body[0].end_lineno + 1))
    numbered = enumerate(source.splitlines(), 1)
    return sum(number not in left_out and bool(re.search(rf"\b{name}\b", line)) for number, line in numbered)


def test_reference_lists_every_public_name():
    listed = "".join(path.read_text() for path in (ROOT / "docs" / "reference").glob("*.md"))
    missing = [name for name in bf.__all__ if not re.search(rf":: {name}\b", listed)]
    assert not missing


def test_outputs_are_compared_by_the_digits_shown():
    assert same("u 0.12 m", "u 0.1249 m\n")
    assert not same("u 0.12 m", "u 0.14 m")
    assert not same("u 0.12 m", "u 0.126 m")
    assert not same("27.38 K", "27.39 K")
    assert same("a ... 3 c", "a b 3 c")
    assert not same("3 iterations", "4 iterations")
    assert same("[ 1.0e-17 2.]", "[-3.1e-18  2.]")
