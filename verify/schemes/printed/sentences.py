"""Sentences on a printed table's conditions and digits, from their judgement."""

from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.prose import Prose, count, prose, read_prose
from verify.schemes.printed.judgement import AS_PRINTED, WITHIN, Judgement
from verify.schemes.printed.printed_numbers import PrintedNumbers, rounded_to
from verify.schemes.printed.solutions import Misprint
from verify.verdict import Verdict

Details = tuple[tuple[str, ...], ...]
Ruling = tuple[Verdict, Prose, Details]
_MOST_SUSPECTS = 8  # limit of the possible misprints that are listed


def ruling_on_order(judgement: Judgement, claimed: int) -> Ruling:
    """Return verdict, sentence and rows on the claim that the table has the claimed order."""
    if judgement.verdict is Verdict.REFUTED:
        return (
            Verdict.REFUTED,
            read_prose(_text_of_excluded(judgement, claimed)),
            _rows_of_moved(judgement),
        )
    return judgement.verdict, read_prose(_text_of_holding(judgement)), ()


def ruling_on_conditions(judgement: Judgement, what: str) -> Ruling:
    """Return verdict, sentence and rows on the claim `what`, such as "symplectic"."""
    if judgement.verdict is not Verdict.REFUTED:
        return judgement.verdict, read_prose(_text_of_holding(judgement)), ()
    failing = judgement.failing
    if failing is None:
        return (
            Verdict.REFUTED,
            read_prose(_text_of_excluded(judgement, 1)),
            _rows_of_moved(judgement),
        )
    notes = f"{_none_near(judgement)}{_alone(judgement)}"
    sentence = f"not {what}: `{failing.name}` fails by {_short(judgement.residual)}{notes}"
    if not judgement.checked:  # there are no equations: the form of the table decides
        sentence = f"not {what}: {failing.name}"
    return Verdict.REFUTED, read_prose(sentence), _rows_of_moved(judgement)


def _text_of_holding(judgement: Judgement) -> str:
    conditions = count(judgement.checked, "condition")
    if judgement.checked == 1 and judgement.verdict is Verdict.PROVED:
        return "its one condition holds exactly"
    if judgement.verdict is Verdict.PROVED:
        decimals = judgement.numbers is not None and judgement.numbers.exact_up_to
        why = "" if decimals else ", for its coefficients are no decimals"
        return f"all {conditions} hold exactly{why}"
    if judgement.verdict is Verdict.UNDECIDED:
        return f"whether all {conditions} hold exactly is not decided"
    assert judgement.numbers is not None  # noqa: S101 - of rounded numbers it is known
    is_enclosed = judgement.verdict is Verdict.ENCLOSED  # all are shown to hold at the solution
    if judgement.distance is not None and (is_enclosed or judgement.digits is not False):
        shown_note = "" if judgement.shown_count in (None, judgement.checked) else (
            f"; of these {judgement.shown_count} are shown to hold there, and the others, which "
            "depend on them, to 60 digits"
        )  # fmt: skip
        # The printed numbers solve the conditions themselves, to all digits of the balls.
        if judgement.distance < AS_PRINTED:
            return f"all {conditions} hold with the numbers as they are printed{shown_note}"
        return (
            f"exact coefficients that satisfy all {conditions} lie within {_far(judgement)} of "
            f"those printed to {judgement.numbers.digits} decimals, whose residues are up to "
            f"{_short(judgement.largest_residual)}{shown_note}"
        )
    small = "as small as the digits make them" if judgement.digits is None else "of wrong digits"
    near = "that exact ones exist nearby is not shown"
    if judgement.distance is not None:
        near = f"the nearest exact ones are up to {_far(judgement)} away"
    largest = _short(judgement.largest_residual)
    return f"all {conditions} hold but for residues up to {largest}, {small}; {near}"


def _text_of_excluded(judgement: Judgement, claimed: int) -> str:
    if judgement.order >= claimed:  # each condition alone could hold; together they cannot
        far = f"; the nearest exact ones are {_far(judgement)} away" if judgement.distance else ""
        return (
            f"no coefficients within {WITHIN} units of the last printed digits satisfy all "
            f"{judgement.checked} conditions together{far}; residues are up to "
            f"{_short(judgement.largest_residual)}"
        )
    assert judgement.failing is not None  # noqa: S101 - it is what excludes more
    failing, exception = judgement.failing, ""
    if judgement.lower_failure is not None:
        lower, size = judgement.lower_failure[0], _short(judgement.lower_failure[1])
        exception = f", but for wrong digits (of `h^{lower.order}`, `{lower.name}` fails by {size})"
    sentence = (
        f"its order is {judgement.order}{exception}: of `h^{failing.order}`, `{failing.name}` "
        f"fails by {_short(judgement.residual)}{_none_near(judgement)}"
    )
    return sentence + _alone(judgement)


def _none_near(judgement: Judgement) -> str:
    if judgement.numbers is None or not judgement.numbers.units:
        return ""
    return f", and no coefficients within {WITHIN} units of the last digits satisfy it"


def _alone(judgement: Judgement) -> str:
    """Return a sentence on the numbers each of which alone explains the residuals."""
    m = judgement.misprint
    if m is not None:
        explanation = f"`{m.name}`, printed `{m.printed.strip()}`, would be"
        mended = mended_text(judgement, m)
        return f". One number alone explains it: {explanation} `{mended}`"
    suspects = [f"`{m.name}` = `{mended_text(judgement, m)}`" for m in judgement.misprints]
    candidates = ", ".join(suspects[:_MOST_SUSPECTS]) + (
        ", …" if len(suspects) > _MOST_SUSPECTS else ""
    )
    sentence = f"Each of {len(suspects)} numbers alone would explain it, and none is singled out"
    return f". {sentence}: {candidates}" if suspects else ""


def mended_text(judgement: Judgement, m: Misprint) -> str:
    """Return the right text for a misprint, with as many digits."""
    unit = None if judgement.numbers is None else judgement.numbers.last_digits.get(m.name)
    return str(m.value) if unit is None else rounded_to(m.value, unit)


def ruling_on_digits(judgement: Judgement) -> Ruling:
    """Return verdict, sentence and rows on the claim that all digits are right."""
    if (
        judgement.digits is None
        and judgement.distance is not None
        and judgement.distance < AS_PRINTED
    ):
        sentence = (
            "the conditions hold with the numbers as they are printed, and leave some of them free"
        )
        return Verdict.UNDECIDED, prose(sentence), ()
    if judgement.digits is None:
        sentence = (
            "the conditions do not tell all of its digits, or exact ones are not shown to exist"
        )
        return Verdict.UNDECIDED, prose(sentence), ()
    if judgement.distance is None:
        sentence = (
            "no coefficients within one unit of the last printed digits satisfy all conditions"
        )
        message = read_prose(f"{sentence}; the nearest are not known{_alone(judgement)}")
        return Verdict.REFUTED, message, ()
    if judgement.digits:
        sentence = f"exact coefficients lie within {_far(judgement)} of the printed ones"
        verdict = Verdict.ENCLOSED if judgement.verdict is Verdict.ENCLOSED else Verdict.MEASURED
        return verdict, read_prose(sentence), ()
    sentence = (
        "no coefficients within one unit of the last printed digits satisfy all conditions; the "
        f"nearest that do are up to {_far(judgement)} away{_alone(judgement)}"
    )
    return Verdict.REFUTED, read_prose(sentence), _rows_of_moved(judgement)


def _rows_of_moved(judgement: Judgement) -> Details:
    """Return a table of the numbers that are off by more than one unit of their last digit.

    The nearest exact numbers have two more digits.
    """
    if judgement.nearest is None or judgement.numbers is None or not judgement.numbers.units:
        return ()
    numbers: PrintedNumbers = judgement.numbers
    rows = [("number", "printed", "nearest exact", f"off, in {_units(numbers)}")]
    for name, exact in judgement.nearest.items():
        off = (numbers.values[name] - exact) / numbers.units[name]
        if abs(off) > 1:
            printed_text = numbers.numbers[name].strip()
            exact_text = rounded_to(exact, numbers.last_digits[name] / 100)
            rows.append((name, printed_text, exact_text, decimal(off, 3)))
    return tuple(rows) if len(rows) > 1 else ()


def _far(judgement: Judgement) -> str:
    """Format the distance of the nearest exact coefficients, from 100 units on as a number."""
    assert judgement.distance is not None  # noqa: S101 - the callers have one
    assert judgement.nearest is not None  # noqa: S101 - and so its numbers
    assert judgement.numbers is not None  # noqa: S101 - which are rounded
    if judgement.distance < 100:
        return f"`{float(judgement.distance):.2g}` {_units(judgement.numbers)}"
    values = judgement.numbers.values
    largest = max(abs(values[n] - x) for n, x in judgement.nearest.items())
    return f"`{float(largest):.1e}`"


def _units(read: PrintedNumbers) -> str:
    """Return the name of the unit in which a distance is stated."""
    of_doubles = read.units != read.last_digits
    return f"units of the last digit{' (half an ulp where that is more)' if of_doubles else ''}"


def _short(x: Fraction) -> str:
    return f"`{float(x):.2e}`"
