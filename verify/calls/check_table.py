"""`verify.check_table`: printed tables of coefficients, judged by what they claim."""

from os import PathLike
from pathlib import Path

from verify.integrators.tables.check import Judgement
from verify.integrators.tables.check import check_table as check


def check_table(path: str | PathLike[str]) -> list[Judgement]:
    """Each claim of each `[[table]]` of a TOML file, with its verdict, evidence and cost.

    Raises InputError, one line with the file, the line and the table, for what is none.

    >>> import tempfile
    >>> with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
    ...     print(
    ...         '[[table]]\\nname = "Verlet"\\nkind = "splitting"\\norder = 3\\n'
    ...         'first = "kick"\\nsizes = ["1/2", "1", "1/2"]',
    ...         file=file,
    ...         flush=True,
    ...     )
    ...     (found,) = check_table(file.name)
    >>> found.id, str(found.claim.verdict), found.claim.cost.order
    ('Verlet/order', 'REFUTED', 2)
    """
    return check(Path(path))
