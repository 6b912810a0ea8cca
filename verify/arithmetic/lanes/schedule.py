"""The order of a loop's statements: independent ones side by side.

A processor looks some hundred instructions ahead, which is three or four products of vectors. What
waits for a product should not stand right behind it. So of the statements that could come next the
one is taken whose operands are there first, and of such the one from which the longest way leads to
the end. What each computes stays the same, and so do its bits.
"""

import ast
from collections.abc import Sequence

_WAIT = {ast.Mult: 34, ast.Call: 10}  # cycles until a product is there, about
_BUSY = {ast.Mult: 17, ast.Call: 8}  # cycles that it keeps the multipliers busy
_LEAST = 3


def reorder(statements: Sequence[ast.stmt]) -> list[ast.stmt]:
    """Return the same statements in a better order, each after all that it depends on."""
    before = _dependencies(statements)
    after: list[list[int]] = [[] for _ in statements]
    for index, predecessors in enumerate(before):
        for predecessor in predecessors:
            after[predecessor].append(index)
    wait, busy = ([_cycles(s, table) for s in statements] for table in (_WAIT, _BUSY))
    way = [0] * len(statements)
    for index in reversed(range(len(statements))):
        way[index] = wait[index] + max((way[k] for k in after[index]), default=0)
    unmet = [len(predecessors) for predecessors in before]
    available_at = [0] * len(statements)  # when the operands are
    ready = {index for index, count in enumerate(unmet) if not count}
    order, now = [], 0
    while ready:
        # List scheduling: the earliest start counts first, then the longest path to the end; the
        # index makes the order reproducible.
        index = min(ready, key=lambda k: (max(available_at[k], now), -way[k], k))
        ready.remove(index)
        order.append(statements[index])
        now = max(now, available_at[index]) + busy[index]
        for k in after[index]:
            available_at[k] = max(available_at[k], now + wait[index] - busy[index])
            unmet[k] -= 1
            if not unmet[k]:
                ready.add(k)
    return order


def _cycles(statement: ast.stmt, table: dict[type, int]) -> int:
    return max((table.get(type(node), _LEAST) for node in ast.walk(statement)), default=_LEAST)


def _dependencies(statements: Sequence[ast.stmt]) -> list[set[int]]:
    """Return, for each statement, those that must come before it: the writers of the names it
    reads, and those that read or write what it writes."""
    dependencies: list[set[int]] = []
    writer: dict[str, int] = {}
    readers: dict[str, set[int]] = {}
    last_return: set[int] = set()
    for index, statement in enumerate(statements):
        names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
        names_written = {node.id for node in names if isinstance(node.ctx, ast.Store)}
        read = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        if isinstance(statement, ast.If):  # if it does not hold the old value is kept
            read |= names_written
        required = {writer[name] for name in read | names_written if name in writer}
        required |= {k for name in names_written for k in readers.get(name, ())}
        if any(isinstance(node, ast.Return) for node in ast.walk(statement)):
            required |= set(range(index))  # it says where the loop ends: after all before it
            last_return = {index}
        dependencies.append((required | last_return) - {index})
        for name in read:
            readers.setdefault(name, set()).add(index)
        for name in names_written:
            writer[name], readers[name] = index, set()
    return dependencies
