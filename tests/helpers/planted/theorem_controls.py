"""What an argument must answer to a planted error."""

from verify.papers.argument import Argument
from verify.verdict import Verdict


def refused(argument: Argument) -> bool:
    """Whether it is undecided, has no proof, and its table shows a check that failed."""
    failed = any(row[-1] == "does not hold" for row in argument.details)
    return argument.verdict is Verdict.UNDECIDED and argument.proof == "" and failed
