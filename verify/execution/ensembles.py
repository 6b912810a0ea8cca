"""Groups of tasks whose runs are stepped together.

Tasks that name the same `ensemble` take the same steps from other initial values, or with other
step sizes and parameters. They go to a worker in groups, longest first, and in a group each has its
`turn`. They are computed in lockstep: where their runs meet in a kernel, the lanes of the vector
unit have one run each. The results are what each task gives by itself.
"""

from collections.abc import Mapping
from itertools import islice

from verify.execution.task import Task

MOST_AT_ONCE = 24  # under way: three sets of lanes, so that they are full where runs have ended
_LEAST_IN_GROUP = 16  # two sets, so that lanes are full
_MOST_IN_GROUP = 64  # so that results come in, and every worker has some

Group = dict[str, Task]


def groups(tasks: Mapping[str, Task], workers: int) -> list[Group]:
    """Return the groups of tasks that are computed together, the costliest first."""
    by_ensemble: dict[str, Group] = {}
    for name in sorted(tasks, key=lambda name: -tasks[name].cost):
        by_ensemble.setdefault(tasks[name].ensemble or name, {})[name] = tasks[name]
    parts: list[Group] = []
    for group in by_ensemble.values():
        # Every worker gets a part, but no part is so small that lanes stay empty, and none so large
        # that results come in late.
        share = -(-len(group) // max(workers, 1))
        size = min(max(share, _LEAST_IN_GROUP), _MOST_IN_GROUP)
        names = iter(group)
        while part := sorted(islice(names, size), key=lambda name: tasks[name].turn):
            parts.append({name: tasks[name] for name in part})
    return sorted(parts, key=lambda part: -sum(task.cost for task in part.values()))
