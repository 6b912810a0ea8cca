"""`python -m verify` is the command `verify`, and so is `main`, which the installed script calls.

Python itself puts the current folder first on the path, and has imported `verify` and what its own
`-m` needs by the time that this is read; the command `verify` never looks there.
"""

import gc
import os
import sys

_INTERRUPTED = 130
# Objects; what a command imports stays, and to look for cycles in it takes a tenth of the time.
_BETWEEN_COLLECTIONS = 50_000


def main() -> None:
    """Run the command line and exit; an interruption while it is imported is one, too."""
    gc.set_threshold(_BETWEEN_COLLECTIONS, 20, 20)
    try:
        from verify.commands.main import main as run
    except KeyboardInterrupt:
        sys.exit(_INTERRUPTED)
    run()


if __name__ == "__main__":
    # Where verify itself does not come from that folder, nothing else shall.
    here = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # noqa: PTH120
    if not sys.flags.safe_path and os.path.realpath(sys.path[0]) != here:
        del sys.path[0]
    main()
