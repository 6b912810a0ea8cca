"""The entry of `python -m verify`, and of the command `verify`, whose script calls `main`.

`python -m` puts the current folder first on the path, and has imported `verify` and its own modules
before this file is run. The command `verify` has no such entry on its path.
"""

import gc
import os
import sys

_INTERRUPTED = 130  # the exit status
# New objects before a collection of garbage. Imported modules stay for good, and with Python's
# default of 700 a tenth of a short command would go into a search for cycles among them.
_COLLECTION_THRESHOLD = 50_000


def main() -> None:
    """Run the command line; exit with its status, also if the import is interrupted."""
    gc.set_threshold(_COLLECTION_THRESHOLD, 20, 20)
    try:
        from verify.commands.main import main as run
    except KeyboardInterrupt:
        sys.exit(_INTERRUPTED)
    run()


if __name__ == "__main__":
    # If verify itself was not imported from the current folder, no other module may be: a file of
    # the user's, such as random.py, would be imported in place of a library.
    package_parent = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # noqa: PTH120
    if not sys.flags.safe_path and os.path.realpath(sys.path[0]) != package_parent:
        del sys.path[0]
    main()
