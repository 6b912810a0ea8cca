"""What showing a report imports, told by forks of a process that has imported how one is made."""

import atexit
import json
import subprocess
import sys
from functools import cache

from tests.paths import ROOT

_APART = """
import json, os, sys
from tests.unit.pages.test_page import *

for line in sys.stdin:
    child = os.fork()
    if child == 0:
        exec(json.loads(line))
        print(json.dumps(sorted(sys.modules)), flush=True)
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        print("null", flush=True)
"""


@cache
def _process() -> "subprocess.Popen[str]":
    process = subprocess.Popen([sys.executable, "-c", _APART], text=True, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, cwd=ROOT)  # fmt: skip
    atexit.register(process.kill)
    return process


def imported_by(*lines: str) -> frozenset[str]:
    """The modules there are after that code, which may name what test_report_page has."""
    process = _process()
    assert process.stdin
    assert process.stdout
    process.stdin.write(json.dumps("\n".join(lines)) + "\n")
    process.stdin.flush()
    names = json.loads(process.stdout.readline())
    assert names is not None, f"it ended with an error: {lines}"
    return frozenset(names)
