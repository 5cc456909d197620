"""The part of a script that some of its names need: what binds them, what changes them, and so on."""

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from symtable import SymbolTable, symtable

_REACHES_ALL = {"eval", "exec", "globals", "locals", "vars", "setattr", "__import__"}


@dataclass(frozen=True)
class _Statement:
    """Names that a statement at the top of a module binds, uses, sets members of, and calls for their effect.

    All but the first in functions as well. imports: whether what it binds is imported.
    """

    binds: frozenset[str]
    uses: frozenset[str]
    changes: frozenset[str]
    calls: frozenset[str]
    imports: bool

    def touches(self, own: set[str]) -> set[str]:
        """Names whose objects may be others after the statement; own: what the module itself makes."""
        return {*self.binds, *self.changes, *(self.calls & own)}


def needed(tree: ast.Module, names: Iterable[str]) -> ast.Module:
    """Return the statements at the top of a module that names bound there need, in order.

    All of it where that cannot be told: names that nothing binds, `import *`, `global`, eval and the like.
    """
    if any(map(_reaches_all, ast.walk(tree))):
        return tree
    statements = [_statement(node) for node in tree.body]
    bound = {name for statement in statements for name in statement.binds}
    # bf.sweep(...) changes nothing of what a function takes from bf
    defined = bound - {name for statement in statements if statement.imports for name in statement.binds}
    wanted = set(names)
    if not wanted <= bound:
        return tree
    chosen: set[int] = set()
    while more := {i for i, part in enumerate(statements) if wanted & part.touches(defined)} - chosen:
        chosen |= more
        wanted |= {name for i in more for name in (statements[i].uses | statements[i].binds) & bound}
    return ast.Module([tree.body[i] for i in sorted(chosen)], [])


def _reaches_all(node: ast.AST) -> bool:
    if isinstance(node, ast.ImportFrom):
        return any(alias.name == "*" for alias in node.names)
    return isinstance(node, ast.Global) or (isinstance(node, ast.Name) and node.id in _REACHES_ALL)


def _statement(node: ast.stmt) -> _Statement:
    table = symtable(ast.unparse(node), "script", "exec")
    top = table.get_symbols()
    binds = frozenset(symbol.get_name() for symbol in top if symbol.is_assigned() or symbol.is_imported())
    uses = frozenset(symbol.get_name() for symbol in top if symbol.is_referenced()).union(*map(_globals, _below(table)))
    parts = list(ast.walk(node))
    changes = (name for part in parts if _sets_member(part) for name in _root(part))
    calls = (name for part in parts if isinstance(part, ast.Expr) for name in _root(part.value))
    imports = isinstance(node, ast.Import | ast.ImportFrom)
    return _Statement(binds, uses, uses.intersection(changes), uses.intersection(calls), imports)


def _below(table: SymbolTable) -> Iterator[SymbolTable]:
    for inner in table.get_children():
        yield inner
        yield from _below(inner)


def _globals(table: SymbolTable) -> set[str]:
    return {symbol.get_name() for symbol in table.get_symbols() if symbol.is_global()}


def _sets_member(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute | ast.Subscript) and isinstance(node.ctx, ast.Store | ast.Del)


def _root(node: ast.AST) -> Iterator[str]:
    """Name of the object that a member or a call begins with."""
    while isinstance(node, ast.Attribute | ast.Subscript | ast.Call):
        node = node.func if isinstance(node, ast.Call) else node.value
    if isinstance(node, ast.Name):
        yield node.id
