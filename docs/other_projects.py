"""Inventories of other projects for intersphinx, with the names in signatures: links without a network."""

import zlib
from pathlib import Path

# project, page and names on it; $ stands for the name
_PROJECTS = {
    "python": "https://docs.python.org/3/",
    "numpy": "https://numpy.org/doc/stable/",
    "scipy": "https://docs.scipy.org/doc/scipy/",
}
_NAMES = """
python library/functions.html#$ bool float int
python library/stdtypes.html#$ dict list slice str tuple
python library/exceptions.html#$ ImportError OSError RuntimeError ValueError
python library/collections.abc.html#$ collections.abc.Callable collections.abc.Mapping collections.abc.Sequence
python library/concurrent.futures.html#concurrent.futures.Executor concurrent.futures._base.Executor
python library/os.html#$ os.PathLike
python library/pathlib.html#$ pathlib.Path
numpy reference/generated/numpy.ndarray.html#$ numpy.ndarray
scipy reference/generated/scipy.sparse.csr_array.html scipy.sparse._csr.csr_array
"""


def intersphinx_mapping(folder: Path) -> dict[str, tuple[str, str]]:
    """Write an inventory of each project (Sphinx, version 2) into a folder, and return the setting for intersphinx."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = dict.fromkeys(_PROJECTS, "")
    for project, page, *names in map(str.split, _NAMES.strip().splitlines()):
        lines[project] += "".join(f"{name} py:class 1 {page} -\n" for name in names)
    for project, text in lines.items():
        head = f"# Sphinx inventory version 2\n# Project: {project}\n# Version: \n# compressed using zlib\n"
        (folder / f"{project}.inv").write_bytes(head.encode() + zlib.compress(text.encode()))
    return {project: (address, str(folder / f"{project}.inv")) for project, address in _PROJECTS.items()}
