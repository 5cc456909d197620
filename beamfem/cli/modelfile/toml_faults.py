"""What usually causes an error of TOML syntax, and what would be right, in words for those who do not know TOML."""

import re

_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
_PAIR = re.compile(r"\s*([\w.\"'-]+)\s*=")


def line_of(message: str, text: str) -> int:
    """Return the line, from 1, that a message of tomllib names."""
    return _place(message, text)[0]


def in_words(message: str, text: str) -> str:
    """Return a message of tomllib about a text, and what would be right where that is known."""
    line, column = _place(message, text)
    own = (text.splitlines() or [""])[line - 1]
    hint = _hint(message, own, own[column - 1 :])
    return f"{message}; {hint}" if hint else message


def _place(message: str, text: str) -> tuple[int, int]:
    """Return line and column, from 1; of an error at the end of the document, those of its last line."""
    place = _PLACE.search(message)
    if place:
        return int(place[1]), int(place[2])
    lines = text.rstrip().splitlines()
    return max(len(lines), 1), len(lines[-1]) + 1 if lines else 1


def _hint(message: str, line: str, rest: str) -> str:
    """Return what would be right on a line whose part `rest` could not be read, empty if there is nothing to say."""
    if message.startswith("Cannot overwrite"):
        pair = _PAIR.match(line)
        return f"the key {pair[1]} is there twice" if pair else "above, its header has another number of brackets"
    if message.startswith("Cannot declare"):
        return "the table is there twice; only those in double brackets, such as [[loads]], may be repeated"
    if message.startswith("Invalid value"):
        return _of_value(rest)
    if message.startswith("Expected newline"):
        return "only a comment may follow a value on its line, and numbers are written like 5.0, 2e-3 or 1000.5"
    if message.startswith("Invalid initial character"):
        return "a table in braces must be on one line, without a comma at its end"
    if message.startswith("Illegal character '\\n'"):
        return "a quotation mark is missing at the end of a text"
    if message.startswith("Expected ']' at the end of a table declaration") and rest:
        return "names are of A-Z, a-z, 0-9, - and _; others are written in quotation marks"
    if message.startswith("Expected '='"):
        return "keys and their values are written: key = value"
    return "paths may be written with /" if message.startswith("Unescaped") else ""


def _of_value(rest: str) -> str:
    word = re.match(r"[^\s,\]}#]*", rest)
    given = word[0] if word else ""
    if given in ("True", "False"):
        return f"write {given.lower()}"
    if re.match(r"[+-]?\.\d", given):
        return f"numbers begin with a digit: {given.replace('.', '0.', 1)}"
    if given.startswith("("):
        return "arrays are written in square brackets: [0, 1]"
    return f'texts are written in quotation marks: "{given}"' if re.match(r"[A-Za-z_]", given) else ""
