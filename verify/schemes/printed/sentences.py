"""Sentences on a printed table's conditions and digits, from their judgement."""

from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.prose import Prose, count, prose, read_prose
from verify.schemes.printed.judged import AS_PRINTED, WITHIN, Judged, Misprint
from verify.schemes.printed.printed_numbers import PrintedNumbers, rounded_to
from verify.verdict import Verdict

Details = tuple[tuple[str, ...], ...]
Judgement = tuple[Verdict, Prose, Details]
_MOST = 8  # numbers, each of which alone would explain the residuals


def judgement_of_order(judged: Judged, claimed: int) -> Judgement:
    """Return the judgement that the order can be had within ten units of the digits."""
    if judged.verdict is Verdict.REFUTED:
        return (
            Verdict.REFUTED,
            read_prose(_text_of_excluded(judged, claimed)),
            _rows_of_moved(judged),
        )
    return judged.verdict, read_prose(_text_of_holding(judged)), ()


def judgement_of_conditions(judged: Judged, what: str) -> Judgement:
    """Return the same for conditions that have no order, such as `what`: "symplectic"."""
    if judged.verdict is not Verdict.REFUTED:
        return judged.verdict, read_prose(_text_of_holding(judged)), ()
    failing = judged.failing
    if failing is None:
        return Verdict.REFUTED, read_prose(_text_of_excluded(judged, 1)), _rows_of_moved(judged)
    notes = f"{_none_near(judged)}{_alone(judged)}"
    sentence = f"not {what}: `{failing.name}` fails by {_short(judged.residue)}{notes}"
    if not judged.checked:  # no equation: it is said of the table's form
        sentence = f"not {what}: {failing.name}"
    return Verdict.REFUTED, read_prose(sentence), _rows_of_moved(judged)


def _text_of_holding(judged: Judged) -> str:
    conditions = count(judged.checked, "condition")
    if judged.checked == 1 and judged.verdict is Verdict.PROVED:
        return "its one condition holds exactly"
    if judged.verdict is Verdict.PROVED:
        decimals = judged.read is not None and judged.read.exact_up_to
        why = "" if decimals else ", for its coefficients are no decimals"
        return f"all {conditions} hold exactly{why}"
    if judged.verdict is Verdict.UNDECIDED:
        return f"whether all {conditions} hold exactly is not decided"
    assert judged.read is not None  # noqa: S101 - of rounded numbers it is known
    is_enclosed = judged.verdict is Verdict.ENCLOSED  # then all are shown to hold there
    if judged.off is not None and (is_enclosed or judged.digits is not False):
        shown_note = "" if judged.shown in (None, judged.checked) else (
            f"; of these {judged.shown} are shown to hold there, and the others, which depend on "
            "them, to 60 digits"
        )  # fmt: skip
        # The printed numbers solve the conditions themselves, to all digits of the balls.
        if judged.off < AS_PRINTED:
            return f"all {conditions} hold with the numbers as they are printed{shown_note}"
        return (
            f"exact coefficients that satisfy all {conditions} lie within {_far(judged)} of those "
            f"printed to {judged.read.digits} decimals, whose residues are up to "
            f"{_short(judged.largest)}{shown_note}"
        )
    small = "as small as the digits make them" if judged.digits is None else "of wrong digits"
    near = "that exact ones exist nearby is not shown"
    if judged.off is not None:
        near = f"the nearest exact ones are up to {_far(judged)} away"
    return f"all {conditions} hold but for residues up to {_short(judged.largest)}, {small}; {near}"


def _text_of_excluded(judged: Judged, claimed: int) -> str:
    if judged.order >= claimed:  # each condition alone could hold; together they cannot
        far = f"; the nearest exact ones are {_far(judged)} away" if judged.off else ""
        return (
            f"no coefficients within {WITHIN} units of the last printed digits satisfy all "
            f"{judged.checked} conditions together{far}; residues are up to "
            f"{_short(judged.largest)}"
        )
    assert judged.failing is not None  # noqa: S101 - it is what excludes more
    but = ""
    if judged.lower is not None:
        lower, by = judged.lower[0], _short(judged.lower[1])
        but = f", but for wrong digits (of `h^{lower.order}`, `{lower.name}` fails by {by})"
    sentence = (
        f"its order is {judged.order}{but}: of `h^{judged.failing.order}`, `{judged.failing.name}` "
        f"fails by {_short(judged.residue)}{_none_near(judged)}"
    )
    return sentence + _alone(judged)


def _none_near(judged: Judged) -> str:
    if judged.read is None or not judged.read.units:
        return ""
    return f", and no coefficients within {WITHIN} units of the last digits satisfy it"


def _alone(judged: Judged) -> str:
    """Return the one misprinted number that explains the residuals; or that each of several
    does."""
    m, several = (
        judged.misprint,
        [f"`{m.name}` = `{mended_text(judged, m)}`" for m in judged.misprints],
    )
    if m is not None:
        explanation = (
            f"`{m.name}`, printed `{m.printed.strip()}`, would be `{mended_text(judged, m)}`"
        )
        return f". One number alone explains it: {explanation}"
    candidates = ", ".join(several[:_MOST]) + (", …" if len(several) > _MOST else "")
    sentence = f"Each of {len(several)} numbers alone would explain it, and none is singled out"
    return f". {sentence}: {candidates}" if several else ""


def mended_text(judged: Judged, m: Misprint) -> str:
    """Return the text that would be printed in its place, with as many digits."""
    unit = None if judged.read is None else judged.read.last_digits.get(m.name)
    return str(m.value) if unit is None else rounded_to(m.value, unit)


def judgement_of_digits(judged: Judged) -> Judgement:
    """Return the judgement that all digits are right to one unit of the last."""
    if judged.digits is None and judged.off is not None and judged.off < AS_PRINTED:
        sentence = (
            "the conditions hold with the numbers as they are printed, and leave some of them free"
        )
        return Verdict.UNDECIDED, prose(sentence), ()
    if judged.digits is None:
        sentence = (
            "the conditions do not tell all of its digits, or exact ones are not shown to exist"
        )
        return Verdict.UNDECIDED, prose(sentence), ()
    if judged.off is None:
        sentence = (
            "no coefficients within one unit of the last printed digits satisfy all conditions"
        )
        message = read_prose(f"{sentence}; the nearest are not known{_alone(judged)}")
        return Verdict.REFUTED, message, ()
    if judged.digits:
        sentence = f"exact coefficients lie within {_far(judged)} of the printed ones"
        verdict = Verdict.ENCLOSED if judged.verdict is Verdict.ENCLOSED else Verdict.MEASURED
        return verdict, read_prose(sentence), ()
    sentence = (
        "no coefficients within one unit of the last printed digits satisfy all conditions; the "
        f"nearest that do are up to {_far(judged)} away{_alone(judged)}"
    )
    return Verdict.REFUTED, read_prose(sentence), _rows_of_moved(judged)


def _rows_of_moved(judged: Judged) -> Details:
    """Return the numbers whose last digits are off by more than a unit, and exact ones with two
    more digits."""
    if judged.nearest is None or judged.read is None or not judged.read.units:
        return ()
    numbers: PrintedNumbers = judged.read
    rows = [("number", "printed", "nearest exact", f"off, in {_units(numbers)}")]
    for name, exact in judged.nearest.items():
        off = (numbers.values[name] - exact) / numbers.units[name]
        if abs(off) > 1:
            printed_text = numbers.numbers[name].strip()
            exact_text = rounded_to(exact, numbers.last_digits[name] / 100)
            rows.append((name, printed_text, exact_text, decimal(off, 3)))
    return tuple(rows) if len(rows) > 1 else ()


def _far(judged: Judged) -> str:
    """Return how far the nearest exact coefficients are: in units, or, where it is far,
    absolutely."""
    assert judged.off is not None  # noqa: S101 - the callers have one
    assert judged.nearest is not None  # noqa: S101 - and so its numbers
    assert judged.read is not None  # noqa: S101 - which are rounded
    if judged.off < 100:
        return f"`{float(judged.off):.2g}` {_units(judged.read)}"
    values = judged.read.values
    largest = max(abs(values[n] - x) for n, x in judged.nearest.items())
    return f"`{float(largest):.1e}`"


def _units(read: PrintedNumbers) -> str:
    """Return the name of the unit in which a distance is stated."""
    of_doubles = read.units != read.last_digits
    return f"units of the last digit{' (half an ulp where that is more)' if of_doubles else ''}"


def _short(x: Fraction) -> str:
    return f"`{float(x):.2e}`"
