"""`python -m verify` is the command `verify`, and so is `main`, which the installed script calls.

Python itself puts the current folder first on the path, and has imported `verify` and what its own
`-m` needs by the time that this is read; the command `verify` never looks there.
"""

import os
import sys

_INTERRUPTED = 130


def main() -> None:
    """Run the command line and exit; an interruption while it is imported is one, too."""
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
