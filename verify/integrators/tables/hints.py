"""Hints at what would be right: told only where all that the table claims holds with them."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from verify.integrators.tables.told import TableClaim, nearest_texts
from verify.schemes.printed.judged import Judged
from verify.schemes.printed.misprint import Misprint
from verify.schemes.printed.sentences import mended_text
from verify.verdict import Verdict

_DIGITS = "digits"  # other numbers may have wrong ones


class Hints:
    """Those of one table. `again`: its claims with these numbers in place of printed ones."""

    def __init__(self, again: Callable[[Mapping[str, str]], Iterable[TableClaim]] | None) -> None:
        self._again = again
        self.one: Misprint | None = None

    def kept(self, found: Judged) -> Judged:
        """What was found, with the hint that explains all claims, and without one that does not."""
        refuted = found.verdict is Verdict.REFUTED
        if self._again is None or not (refuted or found.digits is False):
            return found
        if self.one is not None:
            return replace(found, misprint=self.one)
        m = found.misprint
        if m is not None:
            if self._holds({m.name: mended_text(found, m)}):
                self.one = m
                return found
            found = replace(found, misprint=None)
        if not refuted or found.nearest is None:
            return found
        if self._holds(nearest_texts(found) or {}):
            return found
        return replace(found, nearest=None, off=None)

    def _holds(self, numbers: Mapping[str, str]) -> bool:
        assert self._again is not None  # noqa: S101 - the caller has looked
        made = self._again({name: text.replace("−", "-") for name, text in numbers.items()})
        return all(x.verdict is not Verdict.REFUTED or x.kind.endswith(_DIGITS) for x in made)


NONE = Hints(None)
