"""Files that were written, as paths that notebooks show."""

import atexit
from base64 import b64encode
from html import escape
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from beamfem.atomic_write import path_ending

_HEIGHT = 640  # of a page in a cell [pixels]
_KINDS = {".png": "image/png", ".gif": "image/gif", ".mp4": "video/mp4"}


class WrittenFile(type(Path())):  # type: ignore[misc]
    """The path of a page, a picture or an animation, which a notebook displays at the end of a cell."""

    def _repr_html_(self) -> str | None:
        """Return the embedded file for a cell; None if it has been deleted or is of another kind."""
        if not self.is_file():
            return None
        kind = self.suffix.lower()
        if kind == ".html":
            page = escape(self.read_text(encoding="utf-8"))
            return f'<iframe srcdoc="{page}" style="width: 100%; height: {_HEIGHT}px; border: 0"></iframe>'
        if kind not in _KINDS:
            return None
        data = f"data:{_KINDS[kind]};base64,{b64encode(self.read_bytes()).decode()}"
        if kind == ".mp4":
            return f'<video controls loop src="{data}" style="max-width: 100%"></video>'
        return f'<img src="{data}" style="max-width: 100%">'


def file_to_write(path: str | PathLike[str] | None, kind: str, *suffixes: str, example: str) -> WrittenFile:
    """Return the path of a file of a kind; without one, of a file that is deleted when Python ends.

    Raises InputError for another suffix.
    """
    if path is None:
        folder = TemporaryDirectory(prefix="beamfem-")
        atexit.register(folder.cleanup)
        path = Path(folder.name) / example
    return WrittenFile(path_ending(path, kind, *suffixes, example=example))
