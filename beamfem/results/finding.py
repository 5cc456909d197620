"""A problem found in results: a sentence, and the category of the Python warning if it is large."""

from typing import NamedTuple


class Finding(NamedTuple):
    """A sentence for `warnings` of a result; kind: category of its Python warning, None if it is too small for one."""

    sentence: str
    kind: type[Warning] | None = None
