"""Plants the mutant that the environment names, before anything of `verify` is imported.

Python imports this file at its start where its folder is on PYTHONPATH: a test's own process, and
each that it starts.
"""

import os
import sys

_NAMED = os.environ.get("VERIFY_MUTANT")
if _NAMED:
    sys.path.append(os.environ["VERIFY_MUTANT_ROOT"])
    from tests.mutants.planted import planted

    _module, _, _index = _NAMED.partition(":")
    planted(_module, int(_index))
    sys.path.pop()
