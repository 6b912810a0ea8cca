"""A cause: one mistake, or one fact, that explains why several statements do not hold.

[[cause]]
says = "Both tables print `1/N` for MSE."   # in a sentence; a formula stands between backticks
explains = ["table-1", "table-2"]            # statements that do not hold because of it
shown_by = ["mse-is-1-over-n"]               # claims, ours, that show it; may be left out
"""

from collections.abc import Collection
from typing import Annotated

from pydantic import Field

from verify.errors import InputError
from verify.scenes.frozen import ProseText, WithProse


class Cause(WithProse):
    """See the module's text for the keys."""

    says: ProseText
    """The cause in a sentence."""
    explains: Annotated[tuple[str, ...], Field(min_length=1, max_length=100)]
    """The ids of the statements that it explains."""
    shown_by: Annotated[tuple[str, ...], Field(max_length=100)] = ()
    """The ids of the claims that show it."""

    def check(self, statements: Collection[str], claims: Collection[str]) -> None:
        """Raise InputError where a statement or a claim is unknown."""
        # Unknown ids are refused here, since a page would silently show no link for them.
        for key, names, allowed in (
            ("explains", self.explains, statements), ("shown_by", self.shown_by, claims),
        ):  # fmt: skip
            for name in names:
                if name not in allowed:
                    what = "statement" if key == "explains" else "claim"
                    raise InputError(key, name, f"is no id of a {what} of this file")
