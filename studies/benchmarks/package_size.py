"""Size of the package: files, lines, names, and how much of it a fresh cantilever passes through."""

import sys
from collections import Counter
from pathlib import Path
from types import FrameType

import beamfem as bf
from beamfem.tables import as_text
from studies.benchmarks.fresh_models import model, tip

PACKAGE = Path(bf.__file__).parent


def passed() -> Counter[str]:
    """Return how often a fresh cantilever of 4 elements calls the functions of each file of the package."""
    calls: Counter[str] = Counter()

    def count(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and Path(frame.f_code.co_filename).is_relative_to(PACKAGE):
            calls[frame.f_code.co_filename] += 1

    tip(model(bf.CRBF(1), 4, 1.0))  # imports and compiles
    sys.setprofile(count)
    try:
        tip(model(bf.CRBF(1), 4, 2.0))
    finally:
        sys.setprofile(None)
    return calls


def main() -> dict[str, int]:
    """Print the figures and return them by name."""
    files = [path for path in PACKAGE.rglob("*.py") if "shipped" not in path.parts]
    names = Counter(path.name for path in files if path.name != "__init__.py")
    calls = passed()
    figures = {
        "files": len(files),
        "lines": sum(len(path.read_text().splitlines()) for path in files),
        "lines of the command": sum(len(p.read_text().splitlines()) for p in files if p.parent.name == "cli"),
        "names of several files": sum(number > 1 for number in names.values()),
        "files that a fresh cantilever passes": len(calls),
        "calls in them": calls.total(),
    }
    print(as_text(("figure", "number"), list(figures.items()), "size of the package"))
    return figures


if __name__ == "__main__":
    main()
