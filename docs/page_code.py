"""The code of a page: its blocks, and how they run one after the other."""

import contextlib
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.S | re.M)


@dataclass(frozen=True)
class Block:
    """A block of a page: its code, the line it starts after, the output that the page shows (None for none).

    end: where the block and its output end in the text.
    """

    code: str
    line: int
    output: str | None
    end: int


def blocks_of(text: str) -> list[Block]:
    """Python blocks in order; a text block shows what the python block before it prints."""
    found: list[Block] = []
    for fence in FENCE.finditer(text):
        language, body = fence.groups()
        if language == "python":
            found.append(Block(body, text[: fence.start(2)].count("\n"), None, fence.end()))
        elif language == "text":
            assert found, "a text block is the output of a python block, and there is none before"
            assert found[-1].output is None, "two outputs of one block"
            found[-1] = Block(found[-1].code, found[-1].line, body, fence.end())
    return found


def run(page: Path, text: str) -> Iterator[tuple[Block, str]]:
    """Run the blocks of a page in one namespace; a block whose first line is `# name.py` becomes that file."""
    namespace: dict[str, object] = {"__name__": "page"}
    for block in blocks_of(text):
        file = re.match(r"# (\w+\.py)\n", block.code)
        if file:
            Path(file[1]).write_text(block.code)
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            # empty lines in front: a traceback names the line of the page
            exec(compile("\n" * block.line + block.code, str(page), "exec"), namespace)
        yield block, printed.getvalue()
