"""The order of a loop's statements: independent ones side by side.

A processor looks some hundred instructions ahead, which is three or four products of vectors. A
statement that waits for a product should not stand right behind it. So of the statements that may
come next the one is chosen whose operands are available first; of several such, the one from which
the longest path leads to the end. The statements and their bits stay the same.
"""

import ast
from collections.abc import Sequence

# Estimates: the cycles until the result is available, and those for which the operation occupies
# the multipliers; `_DEFAULT_CYCLES` are both for all other statements.
_LATENCY_CYCLES = {ast.Mult: 34, ast.Call: 10}
_BUSY_CYCLES = {ast.Mult: 17, ast.Call: 8}
_DEFAULT_CYCLES = 3


def reorder(statements: Sequence[ast.stmt]) -> list[ast.stmt]:
    """Return the statements in a better order, each after all statements that it depends on."""
    predecessors_of = _dependencies(statements)
    successors_of: list[list[int]] = [[] for _ in statements]
    for index, predecessors in enumerate(predecessors_of):
        for predecessor in predecessors:
            successors_of[predecessor].append(index)
    wait, busy = (
        [_cycles(s, table) for s in statements] for table in (_LATENCY_CYCLES, _BUSY_CYCLES)
    )
    path = [0] * len(statements)  # cycles of the longest path to the end
    for index in reversed(range(len(statements))):
        path[index] = wait[index] + max((path[k] for k in successors_of[index]), default=0)
    unmet = [len(predecessors) for predecessors in predecessors_of]
    available_at = [0] * len(statements)  # cycles; when a statement's operands are available
    ready = {index for index, count in enumerate(unmet) if not count}
    order, now = [], 0
    while ready:
        # List scheduling: the earliest start counts first, then the longest path to the end; the
        # index makes the order reproducible.
        index = min(ready, key=lambda k: (max(available_at[k], now), -path[k], k))
        ready.remove(index)
        order.append(statements[index])
        now = max(now, available_at[index]) + busy[index]
        for k in successors_of[index]:
            available_at[k] = max(available_at[k], now + wait[index] - busy[index])
            unmet[k] -= 1
            if not unmet[k]:
                ready.add(k)
    return order


def _cycles(statement: ast.stmt, table: dict[type, int]) -> int:
    return max(
        (table.get(type(node), _DEFAULT_CYCLES) for node in ast.walk(statement)),
        default=_DEFAULT_CYCLES,
    )


def _dependencies(statements: Sequence[ast.stmt]) -> list[set[int]]:
    """Return for each statement the indices of those that must come before it: the writers of the
    names that it reads, and the readers and writers of the names that it writes."""
    dependencies: list[set[int]] = []
    writer: dict[str, int] = {}
    readers: dict[str, set[int]] = {}
    last_return: set[int] = set()
    for index, statement in enumerate(statements):
        names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
        names_written = {node.id for node in names if isinstance(node.ctx, ast.Store)}
        names_read = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        if isinstance(statement, ast.If):  # a variable keeps its old value if the condition fails
            names_read |= names_written
        required = {writer[name] for name in names_read | names_written if name in writer}
        required |= {k for name in names_written for k in readers.get(name, ())}
        if any(isinstance(node, ast.Return) for node in ast.walk(statement)):
            required |= set(range(index))  # a return stays behind all statements before it
            last_return = {index}
        dependencies.append((required | last_return) - {index})
        for name in names_read:
            readers.setdefault(name, set()).add(index)
        for name in names_written:
            writer[name], readers[name] = index, set()
    return dependencies
