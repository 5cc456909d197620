"""Plain docstrings, which are written for `help()`, as markup for Sphinx."""

import inspect
import re

# names that belong to the code and not to a user; they come after all others in these signatures
_CONSTANTS = ("name", "code", "turns_with", "fills_body", "shear_measures", "vectors", "degree", "director_degree")


def as_markup(app, kind, name, thing, options, lines):
    """Escape what would be markup, show `code` as code and parameters in bold, one a paragraph."""
    names = "|".join(re.escape(parameter) for parameter in _parameters(thing))
    paragraphs = []
    for paragraph in "\n".join(lines).split("\n\n"):
        text = " ".join(line.strip() for line in paragraph.split("\n")).strip()
        if names:
            # "radius [m], angle: ..." stays one phrase; a new one begins where a parameter does
            text = re.sub(rf"(?<=[.;] )(?=(?:{names})(?:, (?:{names}))*(?: [\[(][^:;]*?[\])])?: )", "\n\n", text)
        paragraphs += re.sub(r"(?<=[.;]) (?=(?:Raises|Source:) )", "\n\n", text).split("\n\n")
    marked = []
    for text in paragraphs:
        text = re.sub(r"([\\*|])", r"\\\1", text)
        text = re.sub(r"(?<=\w)_(?!\w)", r"\\_", text)
        text = re.sub(r"`([^`]+)`", lambda code: f"``{code[1].replace(chr(92), '')}``", text)
        if names:
            text = re.sub(rf"^((?:{names})(?:, (?:{names}))*)(?=[ :])", r"**\1**", text)
        marked += [text, ""]
    lines[:] = marked


def _parameters(thing):
    try:
        return list(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        return []


def without_constants(app, kind, name, thing, options, signature, returns):
    """Leave constants of the code out of the signatures of fields, coordinates and forces; protocols have none."""
    if getattr(thing, "_is_protocol", False):
        return "", returns
    if kind != "class" or not getattr(thing, "__module__", "").startswith("beamfem.element") or "Element" in name:
        return None
    kept = [p for p in inspect.signature(thing).parameters.values() if p.name not in _CONSTANTS]
    return str(inspect.Signature([p.replace(annotation=p.annotation) for p in kept])), returns
