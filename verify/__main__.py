"""The entry of `python -m verify`, and of the command `verify`, whose script calls `main`.

Python itself puts the current folder first on the path, and has imported `verify` and what its own
`-m` needs by the time that this is read; the command `verify` never looks there.
"""

import gc
import os
import sys

_INTERRUPTED = 130
# Objects between two collections: imported modules stay for good, and Python's default of 700 would
# spend a tenth of a short command on looking for cycles among them.
_BETWEEN_COLLECTIONS = 50_000


def main() -> None:
    """Run the command line and exit, with the status of an interruption also during the import."""
    gc.set_threshold(_BETWEEN_COLLECTIONS, 20, 20)
    try:
        from verify.commands.main import main as run
    except KeyboardInterrupt:
        sys.exit(_INTERRUPTED)
    run()


if __name__ == "__main__":
    # Python has put the current folder first on the path. Where verify itself does not come from
    # that folder, no other module may: a file of the user's, such as random.py, would be imported.
    package_parent = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # noqa: PTH120
    if not sys.flags.safe_path and os.path.realpath(sys.path[0]) != package_parent:
        del sys.path[0]
    main()
