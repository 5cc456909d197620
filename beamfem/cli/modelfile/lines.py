"""The line of every key of a TOML text; tomllib gives the values only.

The text has already been parsed by tomllib, so that no errors need to be handled here.
"""

import re
import tomllib
from bisect import bisect_left

Path = tuple[str | int, ...]

_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_SCALAR = re.compile(r"[^,\]}#\n]*")
_STRINGS = (
    re.compile(r'"""(?:\\.|[^\\])*?"""(?:"{1,2}(?!"))?', re.S),
    re.compile(r"'''.*?'''(?:'{1,2}(?!'))?", re.S),
    re.compile(r'"(?:\\.|[^"\\])*"'),
    re.compile(r"'[^']*'"),
)


def key_lines(text: str) -> dict[Path, int]:
    """Return the line, from 1, where each key and each item of an array begins; items are counted from 0."""
    return _Scan(text).document()


class _Scan:
    def __init__(self, text: str) -> None:
        self.text = text
        self.breaks = [match.start() for match in re.finditer("\n", text)]
        self.at = 0
        self.found: dict[Path, int] = {}
        self.arrays: dict[Path, int] = {}  # last item of every array of tables

    def document(self) -> dict[Path, int]:
        table: Path = ()
        self.skip()
        while self.at < len(self.text):
            if self.text[self.at] == "[":
                table = self.header()
            else:
                self.pair(table)
            self.skip()
        return self.found

    def skip(self) -> None:
        self.match(_SPACE)

    def match(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self.text, self.at)
        self.at = match.end() if match else self.at
        return match.group() if match else ""

    def note(self, path: Path, start: int) -> None:
        line = bisect_left(self.breaks, start) + 1
        for end in range(1, len(path) + 1):
            self.found.setdefault(path[:end], line)

    def header(self) -> Path:
        start = self.at
        array = self.text.startswith("[[", start)
        self.at += 2 if array else 1
        keys = self.keys()
        self.at += 2 if array else 1
        path: Path = ()
        for key in keys[:-1]:
            path = (*path, key)
            if path in self.arrays:
                path = (*path, self.arrays[path])
        path = (*path, keys[-1])
        if array:
            self.arrays[path] = self.arrays.get(path, -1) + 1
            path = (*path, self.arrays[path])
        self.note(path, start)
        return path

    def keys(self) -> Path:
        """Read a dotted key up to the character after it."""
        keys = []
        while True:
            self.skip()
            raw = self.match(_BARE_KEY) or self.string()
            keys.append(next(iter(tomllib.loads(f"{raw} = 0"))))
            self.skip()
            if self.text[self.at] != ".":
                return tuple(keys)
            self.at += 1

    def string(self) -> str:
        """Read the string that begins here."""
        for pattern in _STRINGS:
            if text := self.match(pattern):
                return text
        return ""

    def pair(self, table: Path) -> None:
        start = self.at
        path = (*table, *self.keys())
        self.note(path, start)
        self.at += 1
        self.skip()
        self.value(path)

    def value(self, path: Path) -> None:
        opening = self.text[self.at]
        if opening not in "[{":
            _ = self.string() or self.match(_SCALAR)
            return
        self.at += 1
        self.skip()
        item = 0
        while self.text[self.at] not in "]}":
            if opening == "{":
                self.pair(path)
            else:
                self.note((*path, item), self.at)
                self.value((*path, item))
                item += 1
            self.skip()
            if self.text[self.at] == ",":
                self.at += 1
                self.skip()
        self.at += 1
