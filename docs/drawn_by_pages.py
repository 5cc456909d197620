"""Pictures of a page, drawn by its own code while Sphinx builds, and its code as a script and a notebook.

Blocks of a page run one after the other; an example that a page includes runs on its own, and its time is told.
"""

import ast
import contextlib
import io
import json
import logging
import re
import runpy
import shutil
import sys
import tempfile
import time
import warnings
from pathlib import Path

from page_code import blocks_of, run

_DRAWS = re.compile(r'"out/\w+\.(?:png|gif)"')
_KINDS = (("script", ".py"), ("notebook", ".ipynb"))
_EXAMPLE = re.compile(r"^```\{literalinclude\} (\S+\.py)\n```$", re.M)
_HEADING = re.compile(r"^# .*\n", re.M)
_PICTURES = "_pictures"  # beside the pages, as Sphinx wants it; not in the repository


def draw(app) -> None:
    """Run the pages that draw, and keep their pictures and where they belong."""
    warnings.simplefilter("ignore", UserWarning)  # of meshes that pages refine, or that lock to show it
    source = Path(app.srcdir)
    shutil.rmtree(source / _PICTURES, ignore_errors=True)
    app.drawn_by_pages = {}
    _of_drawings(source / "drawings", source / _PICTURES / "drawings")
    for noisy in ("skfem", "ezdxf"):
        logging.getLogger(noisy).setLevel(logging.WARNING)
    for page in sorted(source.rglob("*.md")):
        name = page.relative_to(source).with_suffix("").as_posix()
        text = page.read_text(encoding="utf-8")
        if _DRAWS.search(text):
            app.drawn_by_pages[name] = _of_blocks(page, text, source / _PICTURES / name)
        elif _EXAMPLE.search(text):
            app.drawn_by_pages[name] = _of_examples(page, text, source / _PICTURES / name)


def _of_drawings(scripts: Path, keep: Path) -> None:
    """Run the scripts that draw what no page shows the code of; a page names their pictures itself."""
    keep.mkdir(parents=True)
    for script in sorted(scripts.glob("*.py")):
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            runpy.run_path(str(script), run_name="__main__")
            for picture in Path().glob("*.png"):
                shutil.copy(picture, keep)


def _of_blocks(page: Path, text: str, keep: Path) -> list[tuple[int, str]]:
    """Return where in the text of a page something is to be added, and what: the pictures of its blocks."""
    found, known = [], set()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        sys.path.insert(0, folder)
        for block, _ in run(page, text):
            found += [(block.end, shown) for shown in _pictures(Path("out"), keep, known)]
        sys.path.remove(folder)
    title = _HEADING.search(text)
    codes = [block.code.strip() for block in blocks_of(text)]
    script = keep / f"{page.stem}.py"
    script.write_text("\n\n\n".join(codes) + "\n", encoding="utf-8")
    script.with_suffix(".ipynb").write_text(_notebook(title[0], codes), encoding="utf-8")
    below = f"/{_PICTURES}/{keep.relative_to(keep.parents[len(keep.parts) - keep.parts.index(_PICTURES) - 2])}"
    links = [f"{{download}}`{kind} <{below}/{page.stem}{suffix}>`" for kind, suffix in _KINDS]
    return [(title.end(), f"Code of this page: {', '.join(links)}"), *found]


def _notebook(heading: str, codes: list[str]) -> str:
    """Return a notebook with a heading and a cell for each piece of code."""
    cells = [{"cell_type": "markdown", "id": "heading", "metadata": {}, "source": heading.strip()}]
    for number, code in enumerate(codes):
        cell = {"cell_type": "code", "id": f"code-{number}", "metadata": {}, "source": code}
        cells.append({**cell, "execution_count": None, "outputs": []})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return json.dumps({"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5})


def _of_examples(page: Path, text: str, keep: Path) -> list[tuple[int, str]]:
    """Return the same of examples, with what they print and the time that they take."""
    found = []
    for example in _EXAMPLE.finditer(text):
        printed = io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            begun = time.perf_counter()
            with contextlib.redirect_stdout(printed):
                runpy.run_path(str(page.parent / example[1]), run_name="__main__")
            seconds = time.perf_counter() - begun
            took = f"{1e3 * seconds:.0f} ms" if seconds < 1.0 else f"{seconds:.1f} s"
            words = f"It prints, in {took} with all files:\n\n```text\n{printed.getvalue()}```"
            shown = [words, *_pictures(Path("out/examples"), keep, set())]
            found += [(example.end(), own) for own in shown]
        script = page.parent / example[1]
        code = script.read_text(encoding="utf-8")
        heading, rest = ast.get_docstring(ast.parse(code)), code.split('"""', 2)[2]
        pieces = re.split(r"\n\n+(?=\S)", rest.strip())
        (keep / f"{script.stem}.ipynb").write_text(_notebook(heading, pieces), encoding="utf-8")
    return found


def _pictures(folder: Path, keep: Path, known: set[str]) -> list[str]:
    """Keep the pictures of a folder that are not known yet; return how a page shows them."""
    new = [own for own in sorted((*folder.glob("*.png"), *folder.glob("*.gif"))) if own.name not in known]
    keep.mkdir(parents=True, exist_ok=True)
    for picture in new:
        known.add(picture.name)
        shutil.copy(picture, keep)
    below = keep.relative_to(next(own for own in keep.parents if own.name == _PICTURES).parent)
    return [f"![What this draws](/{below.as_posix()}/{picture.name})" for picture in new]


def with_pictures(app, env, added, changed, removed) -> list[str]:
    """Return the pages that draw: they are built anew even where their text has not changed."""
    return list(app.drawn_by_pages)


def show(app, name: str, source: list[str]) -> None:
    """Put the pictures of a page behind their blocks."""
    text = source[0]
    for end, shown in reversed(app.drawn_by_pages.get(name, [])):
        text = f"{text[:end]}\n\n{shown}\n{text[end:]}"
    source[0] = text
