"""What is said of a printed table's conditions and digits, from what was found of them."""

from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.prose import Prose, count, prose, read_prose
from verify.schemes.printed.judged import AS_PRINTED, WITHIN, Judged, Misprint
from verify.schemes.printed.printed_numbers import PrintedNumbers, rounded_to
from verify.verdict import Verdict

Details = tuple[tuple[str, ...], ...]
Judgement = tuple[Verdict, Prose, Details]
_MOST = 8  # numbers of which each would explain what is found


def of_printed(found: Judged, claimed: int) -> Judgement:
    """Whether the order can be had within ten units of the digits."""
    if found.verdict is Verdict.REFUTED:
        return Verdict.REFUTED, read_prose(_excluded(found, claimed)), _moved(found)
    return found.verdict, read_prose(_held(found)), ()


def of_conditions(found: Judged, what: str) -> Judgement:
    """The same of conditions that are of no order, such as `what`: "symplectic"."""
    if found.verdict is not Verdict.REFUTED:
        return found.verdict, read_prose(_held(found)), ()
    failing = found.failing
    if failing is None:
        return Verdict.REFUTED, read_prose(_excluded(found, 1)), _moved(found)
    rounded = _none_near(found)
    said = f"not {what}: `{failing.name}` fails by {_short(found.residue)}{rounded}{_alone(found)}"
    if not found.checked:  # no equation: it is said of the table's form
        said = f"not {what}: {failing.name}"
    return Verdict.REFUTED, read_prose(said), _moved(found)


def _held(found: Judged) -> str:
    conditions = count(found.checked, "condition")
    if found.checked == 1 and found.verdict is Verdict.PROVED:
        return "its one condition holds exactly"
    if found.verdict is Verdict.PROVED:
        decimals = found.read is not None and found.read.exact_up_to
        why = "" if decimals else ", for its coefficients are no decimals"
        return f"all {conditions} hold exactly{why}"
    if found.verdict is Verdict.UNDECIDED:
        return f"whether all {conditions} hold exactly is not decided"
    assert found.read is not None  # noqa: S101 - of rounded numbers it is known
    enclosed = found.verdict is Verdict.ENCLOSED  # then all are shown to hold there
    if found.off is not None and (enclosed or found.digits is not False):
        rest = "" if found.shown in (None, found.checked) else (
            f"; of these {found.shown} are shown to hold there, and the others, which depend on "
            "them, to 60 digits"
        )  # fmt: skip
        if found.off < AS_PRINTED:
            return f"all {conditions} hold with the numbers as they are printed{rest}"
        return (
            f"exact coefficients that satisfy all {conditions} lie within {_far(found)} of those "
            f"printed to {found.read.digits} decimals, whose residues are up to "
            f"{_short(found.largest)}{rest}"
        )
    small = "as small as the digits make them" if found.digits is None else "of wrong digits"
    near = "that exact ones exist nearby is not shown"
    if found.off is not None:
        near = f"the nearest exact ones are up to {_far(found)} away"
    return f"all {conditions} hold but for residues up to {_short(found.largest)}, {small}; {near}"


def _excluded(found: Judged, claimed: int) -> str:
    if found.order >= claimed:  # each condition alone could hold; together they cannot
        far = f"; the nearest exact ones are {_far(found)} away" if found.off else ""
        return (
            f"no coefficients within {WITHIN} units of the last printed digits satisfy all "
            f"{found.checked} conditions together{far}; residues are up to {_short(found.largest)}"
        )
    assert found.failing is not None  # noqa: S101 - it is what excludes more
    but = ""
    if found.lower is not None:
        lower, by = found.lower[0], _short(found.lower[1])
        but = f", but for wrong digits (of `h^{lower.order}`, `{lower.name}` fails by {by})"
    said = (
        f"its order is {found.order}{but}: of `h^{found.failing.order}`, `{found.failing.name}` "
        f"fails by {_short(found.residue)}{_none_near(found)}"
    )
    return said + _alone(found)


def _none_near(found: Judged) -> str:
    if found.read is None or not found.read.units:
        return ""
    return f", and no coefficients within {WITHIN} units of the last digits satisfy it"


def _alone(found: Judged) -> str:
    """The one misprinted number that explains what is found; or that each of several does."""
    m, several = (
        found.misprint,
        [f"`{m.name}` = `{mended_text(found, m)}`" for m in found.misprints],
    )
    if m is not None:
        printed = f"`{m.name}`, printed `{m.printed.strip()}`, would be `{mended_text(found, m)}`"
        return f". One number alone explains it: {printed}"
    listed = ", ".join(several[:_MOST]) + (", …" if len(several) > _MOST else "")
    said = f"Each of {len(several)} numbers alone would explain it, and none is singled out"
    return f". {said}: {listed}" if several else ""


def mended_text(found: Judged, m: Misprint) -> str:
    """What would be printed in its place, with as many digits."""
    unit = None if found.read is None else found.read.last_digits.get(m.name)
    return str(m.value) if unit is None else rounded_to(m.value, unit)


def of_digits(found: Judged) -> Judgement:
    """Whether all digits are right to one unit of the last."""
    if found.digits is None and found.off is not None and found.off < AS_PRINTED:
        said = (
            "the conditions hold with the numbers as they are printed, and leave some of them free"
        )
        return Verdict.UNDECIDED, prose(said), ()
    if found.digits is None:
        said = "the conditions do not tell all of its digits, or exact ones are not shown to exist"
        return Verdict.UNDECIDED, prose(said), ()
    if found.off is None:
        said = "no coefficients within one unit of the last printed digits satisfy all conditions"
        told = read_prose(f"{said}; the nearest are not known{_alone(found)}")
        return Verdict.REFUTED, told, ()
    if found.digits:
        said = f"exact coefficients lie within {_far(found)} of the printed ones"
        shown = Verdict.ENCLOSED if found.verdict is Verdict.ENCLOSED else Verdict.MEASURED
        return shown, read_prose(said), ()
    said = (
        "no coefficients within one unit of the last printed digits satisfy all conditions; the "
        f"nearest that do are up to {_far(found)} away{_alone(found)}"
    )
    return Verdict.REFUTED, read_prose(said), _moved(found)


def _moved(found: Judged) -> Details:
    """The numbers whose last digits are off by more than a unit, and exact ones with two more."""
    if found.nearest is None or found.read is None or not found.read.units:
        return ()
    numbers: PrintedNumbers = found.read
    rows = [("number", "printed", "nearest exact", f"off, in {_units(numbers)}")]
    for name, exact in found.nearest.items():
        off = (numbers.values[name] - exact) / numbers.units[name]
        if abs(off) > 1:
            printed = numbers.numbers[name].strip()
            shown = rounded_to(exact, numbers.last_digits[name] / 100)
            rows.append((name, printed, shown, decimal(off, 3)))
    return tuple(rows) if len(rows) > 1 else ()


def _far(found: Judged) -> str:
    """How far the nearest exact coefficients are: in units, or, where it is far, absolutely."""
    assert found.off is not None  # noqa: S101 - the callers have one
    assert found.nearest is not None  # noqa: S101 - and so its numbers
    assert found.read is not None  # noqa: S101 - which are rounded
    if found.off < 100:
        return f"`{float(found.off):.2g}` {_units(found.read)}"
    values = found.read.values
    most = max(abs(values[n] - x) for n, x in found.nearest.items())
    return f"`{float(most):.1e}`"


def _units(read: PrintedNumbers) -> str:
    """In what it is told how far a number is off."""
    of_doubles = read.units != read.last_digits
    return f"units of the last digit{' (half an ulp where that is more)' if of_doubles else ''}"


def _short(x: Fraction) -> str:
    return f"`{float(x):.2e}`"
