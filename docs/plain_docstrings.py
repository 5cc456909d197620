"""Plain docstrings, which are written for `help()`, as markup for Sphinx; napoleon takes their sections from here."""

import inspect
import re

# names that belong to the code and not to a user; they come after all others in these signatures
_CONSTANTS = ("name", "code", "turns_with", "fills_body", "shear_measures", "vectors", "degree", "director_degree")


def as_markup(app, kind, name, thing, options, lines):
    """Escape what would be markup and show `code` as code; examples and underlines of sections stay as they are."""
    shown = False  # an example, which ends with an empty line
    for place, line in enumerate(lines):
        shown = bool(line.strip()) and (shown or line.lstrip().startswith(">>>"))
        if not shown and not re.fullmatch(r"-{3,}", line.strip()):
            lines[place] = _escaped(line)


def _escaped(line):
    line = re.sub(r"([\\*|])", r"\\\1", line)
    line = re.sub(r"(?<=\w)_(?!\w)", r"\\_", line)
    return re.sub(r"`([^`]+)`", lambda code: f"``{code[1].replace(chr(92), '')}``", line)


def without_constants(app, kind, name, thing, options, signature, returns):
    """Leave constants of the code out of the signatures of fields, coordinates and forces; protocols have none."""
    if getattr(thing, "_is_protocol", False):
        return "", returns
    if kind != "class" or not getattr(thing, "__module__", "").startswith("beamfem.element") or "Element" in name:
        return None
    kept = [p for p in inspect.signature(thing).parameters.values() if p.name not in _CONSTANTS]
    return str(inspect.Signature([p.replace(annotation=p.annotation) for p in kept])), returns
