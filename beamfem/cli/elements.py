"""Elements as a text: the name of a preset, with its order if it has one."""

import re

from beamfem.cli.modelfile.elements import PRESETS
from beamfem.element.element import Element
from beamfem.element.fields import Lagrange
from beamfem.element.presets import CRBF
from beamfem.errors import InputError
from beamfem.validation import nearest

_TEXT = re.compile(r"(?P<name>\w+)(?:\((?P<order>\d+)\))?")


def element_from_text(text: str) -> Element:
    """Return the element of a text such as "ANCFCRBF" or "CRBF(4)". Raises InputError."""
    match = _TEXT.fullmatch(text.strip())
    name = match["name"] if match else text
    if not match or name not in PRESETS:
        raise InputError(f"there is no element {name!r}; {nearest(name, PRESETS)}")
    if PRESETS[name] is CRBF:
        if match["order"] is None:
            raise InputError('CRBF needs its order, such as "CRBF(4)"')
        return CRBF(int(match["order"]))
    if match["order"] is not None:
        raise InputError(f"{name} has no order, only CRBF has")
    element = PRESETS[name]()
    assert isinstance(element, Element)
    return element


def text_of_element(element: Element) -> str:
    """Return the text that `element_from_text` reads as this element; if there is none, its name with a remark."""
    texts = [name for name, preset in PRESETS.items() if preset is not CRBF]
    if isinstance(element.field, Lagrange):
        texts.append(f"CRBF({element.field.order})")
    alike = (text for text in texts if element_from_text(text) == element)
    return next(alike, f"{element.name} (in Python only)")
