"""How much memory this computer has, to refuse what cannot fit before it is begun."""

import os

USABLE_FRACTION = 0.8  # of the memory of this computer that a model or a motion may take


def installed_memory() -> int | None:
    """Return the memory of this computer [bytes], None if the system does not tell."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # Windows
        return None


def in_gib(size: float) -> str:
    """Return a size [bytes] as people read it."""
    return f"{size / 2**30:.3g} GiB"
