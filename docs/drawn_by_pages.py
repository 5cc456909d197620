"""Pictures of a page, drawn by its own code while Sphinx builds, behind the blocks that draw them."""

import contextlib
import logging
import re
import shutil
import sys
import tempfile
from pathlib import Path

from page_code import run

_DRAWS = re.compile(r'"out/\w+\.(?:png|gif)"')
_PICTURES = "_pictures"  # beside the pages, as Sphinx wants it; not in the repository


def draw(app) -> None:
    """Run the pages that draw, and keep their pictures and where they belong."""
    source = Path(app.srcdir)
    shutil.rmtree(source / _PICTURES, ignore_errors=True)
    app.drawn_by_pages = {}
    for noisy in ("skfem", "ezdxf"):
        logging.getLogger(noisy).setLevel(logging.WARNING)
    for page in sorted(source.rglob("*.md")):
        name = page.relative_to(source).with_suffix("").as_posix()
        text = page.read_text(encoding="utf-8")
        if _DRAWS.search(text):
            app.drawn_by_pages[name] = _drawn(page, text, source / _PICTURES / name)


def _drawn(page: Path, text: str, keep: Path) -> list[tuple[int, str]]:
    """Return where in the text of a page the pictures of each block belong, and their names."""
    found, known = [], set()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        sys.path.insert(0, folder)
        for block, _ in run(page, text):
            for picture in sorted(Path("out").glob("*.png")) + sorted(Path("out").glob("*.gif")):
                if picture.name not in known:
                    known.add(picture.name)
                    keep.mkdir(parents=True, exist_ok=True)
                    shutil.copy(picture, keep)
                    found.append((block.end, picture.name))
        sys.path.remove(folder)
    return found


def with_pictures(app, env, added, changed, removed) -> list[str]:
    """Return the pages that draw: they are built anew even where their text has not changed."""
    return list(app.drawn_by_pages)


def show(app, name: str, source: list[str]) -> None:
    """Put the pictures of a page behind their blocks."""
    text = source[0]
    for end, picture in reversed(app.drawn_by_pages.get(name, [])):
        text = f"{text[:end]}\n\n![What this draws](/{_PICTURES}/{name}/{picture})\n{text[end:]}"
    source[0] = text
