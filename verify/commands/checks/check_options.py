"""Options of the commands that check, and what these print of verdicts and measurements.

Options name a place, a state with a step size, at which a user's code is to be evaluated. The
verdicts of a check decide its exit status.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import click

from verify.arithmetic.exact import positive, rational, text
from verify.commands.shared.option import flag, option, options
from verify.commands.shared.output import pick, print_line
from verify.commands.shared.proof_output import point_json
from verify.commands.shared.structure_output import print_structures, structure_json
from verify.errors import InputError
from verify.prose import count

if TYPE_CHECKING:
    from verify.integrators.measures.survey import Request
    from verify.integrators.places.trial_places import TrialPlace
    from verify.integrators.results import Counterexample, Finding


allow_undecided_option = flag("--allow-undecided", "Exit status 0 even if a claim is UNDECIDED.")


def is_failure(verdicts: Iterable[str], *, allow_undecided: bool) -> bool:
    """Return True if a verdict is REFUTED, or UNDECIDED without --allow-undecided.

    `verdicts`: those of all requested claims. An undecided claim fails: otherwise a claim that
    nothing decides would pass.
    """
    return any(x == "REFUTED" or (x == "UNDECIDED" and not allow_undecided) for x in verdicts)


def print_tally(verdicts: Iterable[str]) -> None:
    """Print the number of claims of each verdict, the most frequent one first."""
    counts = Counter(map(str, verdicts))
    words = (f"{n} {word}" for word, n in counts.most_common())
    click.echo(f"{count(counts.total(), 'claim')}: {', '.join(words)}")


# -- the places at which a user's code is evaluated ------------------------------------------------

place_options = options(
    option("--q q", "Q", "The displacements of the first state to try: q, or q1,q2,…"),
    option("--p p", "P", "Its momenta: p, or p1,p2,…"),
    option(
        "--scale",
        "NAME=SIZE,…",
        "Sizes of the coordinates, such as q=7000,p=7.5; by default those of H or the map.",
    ),
    option(
        "--within",
        "SIZE",
        "A defect that you allow, such as 1e-8; by default that of the numbers' rounding.",
    ),
)
point_option = option(
    "--point", "Z", "The first state to try, one number for each coordinate, in their order."
)
step_size_option = option(
    "--step-size", "H", "The step size that matters to you, the largest that is tried."
)


def request_from(
    names: Sequence[str],
    *,
    q: str | None,
    p: str | None,
    scale: str | None,
    within: str | None,
    step_size: str | None = None,
    point: str | None = None,
) -> "Request":
    """Return the request that these options describe. Raises InputError."""
    from verify.hamiltonians.coordinates import coordinates_in
    from verify.integrators.measures.survey import Request

    if (q or p) is not None and tuple(names) != coordinates_in(max(len(names) // 2, 1)):
        problem = f"goes with p and q; of {', '.join(names)} use --point"
        raise InputError("--q, --p", q or p or "", problem)
    return Request(
        z=state_from(names, q, p) if point is None else _parse_point(names, q or p, point),
        step_size=None if step_size is None else positive(step_size, "--step-size"),
        scale={} if scale is None else _parse_scale(names, scale),
        within=None if within is None else positive(within, "--within"),
    )


def state_from(names: Sequence[str], q: str | None, p: str | None) -> tuple[Fraction, ...] | None:
    """Return the state p1, …, qn from the texts of q and p, lists with commas.

    None if neither is given. Raises InputError.
    """

    if p is None and q is None:
        return None
    if p is None or q is None:
        raise InputError("--p, --q", p or q or "", "give both or none")
    degrees, z = len(names) // 2, list[Fraction]()
    for name, typed in (("--p", p), ("--q", q)):
        numbers = [rational(part.strip(), name) for part in typed.split(",")]
        if len(numbers) != degrees:
            problem = (
                f"has {len(numbers)} numbers; allowed: {degrees}, one for each degree of freedom"
            )
            raise InputError(name, typed, problem)
        z += numbers
    return tuple(z)


def _parse_point(names: Sequence[str], other: str | None, text: str) -> tuple[Fraction, ...]:

    z = tuple(rational(part.strip(), "--point") for part in text.split(","))
    if other is not None or len(z) != len(names):
        problem = f"goes without --q and --p; allowed: {len(names)} numbers, {', '.join(names)}"
        raise InputError("--point", text, problem)
    return z


def _parse_scale(names: Sequence[str], text: str) -> dict[str, Fraction]:

    sizes: dict[str, Fraction] = {}
    for part in text.split(","):
        name, equals, value = (x.strip() for x in part.partition("="))
        # A name without a number stands for all of its kind: q for q1 … qn.
        coordinates = [x for x in names if name in (x, x[0])]
        if not equals or not coordinates:
            names_text = ", ".join(dict.fromkeys(["q", "p", *names]))
            problem = f"is no size of a coordinate; write NAME=SIZE; allowed: {names_text}"
            raise InputError("--scale", part, problem)
        for coordinate in coordinates:
            sizes[coordinate] = positive(value, "--scale")
    return sizes


def places_json(coordinates: Sequence[str], places: "Sequence[TrialPlace]") -> list[dict[str, str]]:
    """Return the places at which the code was evaluated, each coordinate by its name."""

    return [
        {
            **{name: text(x) for name, x in zip(coordinates, place.z, strict=True)},
            "t": text(place.t),
            "step_size": text(place.step),
            "chosen_by": place.source,
        }
        for place in places
    ]


def keeps_json(finding: "Finding") -> list[dict[str, Any]]:
    """Return the keys of each structure of the finding, those of a proof among them."""

    return [
        {
            **structure_json(kept),
            **pick(kept, "how", "exact"),
            "largest": None if kept.largest is None else f"{kept.largest:.6e}",
            "probe_error": None if kept.probe_error is None else f"{kept.probe_error:.1e}",
            "counterexample": kept.counterexample and example_json(kept.counterexample),
            "way_back": kept.way_back and {
                "units": f"{kept.way_back.units:.6g}", "text": kept.way_back.text,
            },
        }
        for kept in finding.keeps
    ]  # fmt: skip


def example_json(example: "Counterexample") -> dict[str, Any]:
    """Return the keys of a counterexample: its place, and what is seen there."""

    return {
        **point_json(example.z),
        **({} if example.h is None else {"h": text(example.h)}),
        **({} if example.t is None else {"t": text(example.t)}),
        **pick(example, "quantity", "found", "expected"),
    }


def print_keeps(finding: "Finding") -> None:
    """Print each structure of the finding, with what is lost on the way back."""

    for kept in finding.keeps:
        print_structures([kept])
        if kept.way_back is not None:
            print_line("  floats", str(kept.way_back.text))


def print_measured(finding: "Finding") -> None:
    """Print the largest measured defect, and whether det J was 1."""
    if finding.largest is not None and finding.probe_error is not None:
        name = "ΔJ" if finding.degrees == 1 else "S"
        noise = f"the noise of such a value {finding.probe_error:.1e}"
        click.echo(f"  measured |{name}| up to {finding.largest:.1e}; {noise}")
    if finding.degrees > 1 and finding.symplectic is False and finding.area_preserving is not None:
        click.echo(
            f"  det J    is {'' if finding.area_preserving else 'not '}1 where it was measured"
        )


def print_notes(finding: "Finding") -> None:
    """Print the finding's counterexample and notes."""
    if finding.counterexample is not None:
        click.echo(f"  against  {finding.counterexample}")
    for note in finding.notes:
        click.echo(f"  note     {note}")
