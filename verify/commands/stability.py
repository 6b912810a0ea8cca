"""The command `verify stability`: the runs of a scene, judged, and linear theory, exactly.

`verify stability --linear`: a scheme on the harmonic oscillator, or at an equilibrium of H.
"""

import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import Answer
from verify.commands.shared.input import hamiltonian_of, listed
from verify.commands.shared.one_line import scenes_of, start_options, with_one_line
from verify.commands.shared.output import print_once
from verify.commands.shared.tasks import perform, with_tasks
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.studies.stability.equilibrium import LinearAtEquilibrium
    from verify.studies.stability.linear import LinearStability

_OF_H = ("system", "hamiltonian", "params", "q", "p", "step_sizes")
_SHOWN = 12  # digits on a terminal
_MOST_SHOWN = 12  # frequencies there
_SAID = {True: "bounded", False: "unbounded", None: "undecided: its coefficients are irrational"}


def linear_answer(scene: str | None, given: Mapping[str, Any]) -> Answer:
    """What linear theory says; InputError for what does not go with it."""
    if scene is not None:
        raise InputError("SCENE", scene, "does not go with --linear; leave it out")
    of_h = given["system"] is not None or given["hamiltonian"] is not None
    for name, x in given.items():
        takes = name == "schemes" or (of_h and name in _OF_H)
        if not takes and x not in (None, ()):
            shown = x[0] if isinstance(x, tuple) else x
            raise InputError(name, shown, "does not go with --linear; leave it out")
    if len(given["schemes"]) != 1:
        shown = ", ".join(given["schemes"]) or NOT_GIVEN
        raise InputError("schemes", shown, "give one with --linear")
    scheme = str(given["schemes"][0])
    return _at_equilibrium(scheme, given) if of_h else _of_oscillator(scheme)


def _of_oscillator(scheme: str) -> Answer:
    from verify.algebra.expressions.formula_text import to_text
    from verify.studies.stability.nearby_linear import linear_stability

    found = linear_stability(scheme)
    data = {
        "scheme": found.scheme,
        "interval": found.decimal(),
        "interval_exact": found.exact,
        "note": found.note,
        "delta_j": to_text(found.delta_j),
    }
    return Answer(lambda: data, lambda: _print_oscillator(found, data["delta_j"]))


def _print_oscillator(found: "LinearStability", delta_j: str) -> None:
    ends = {"infinite": "for every hω > 0", "0": "for no hω > 0"}
    shown = ends.get(found.exact, f"for 0 < hω < {found.decimal(_SHOWN)}")
    click.echo(f"{found.scheme} on the harmonic oscillator is stable {shown}")
    if found.exact and found.exact not in ends and not found.exact.isdecimal():
        click.echo(f"  exactly  {found.exact}")
    if found.note:
        click.echo(f"  note     {found.note}")
    click.echo(f"  ΔJ       {delta_j}, y = hω")


def _at_equilibrium(scheme: str, given: Mapping[str, Any]) -> Answer:
    from verify.arithmetic.exact import positive
    from verify.hamiltonians.start import point_of
    from verify.studies.stability.equilibrium import linear_at_equilibrium

    exact = hamiltonian_of(given["system"], given["hamiltonian"], given["params"])
    origin = ",".join(["0"] * exact.degrees)
    q, p = (listed(given[name] or origin, exact) for name in ("q", "p"))
    sizes = [positive(h, "step_size") for h in given["step_sizes"]]
    found = linear_at_equilibrium(exact, scheme, point_of(exact, q, p), sizes)
    return Answer(lambda: _data(found), lambda: _print_equilibrium(found))


def _data(found: "LinearAtEquilibrium") -> dict[str, Any]:
    from verify.arithmetic.exact import text
    from verify.hamiltonians.start import shown_of

    exact, interval = found.hamiltonian, found.interval
    return {
        "scheme": found.scheme,
        **exact.texts,
        "q": shown_of(exact, found.point, "q"),
        "p": shown_of(exact, found.point, "p"),
        "frequencies": [
            {"value": f.decimal(), "exact": f.exact, "multiplicity": f.multiplicity}
            for f in found.frequencies
        ],
        "oscillates": found.oscillates,
        "interval": None if interval is None else interval.decimal(),
        "interval_exact": None if interval is None else interval.exact,
        "note": "" if interval is None else interval.note,
        "step_size": found.step_size,
        "step_size_exact": found.step_size_exact,
        "decided": [
            {"step_size": text(h), "bounded": bounded} for h, bounded in found.decided.items()
        ],
    }


def _print_equilibrium(found: "LinearAtEquilibrium") -> None:
    from verify.arithmetic.exact import plain, rational, text

    at = ", ".join(f"{name} = {text(x)}" for name, x in found.point.items() if x) or "the origin"
    click.echo(f"{found.scheme} on the quadratic part of H at {at}")
    click.echo(f"  ω          {_frequencies(found)}")
    if found.interval is not None:
        limit = found.step_size
        ends = {"infinite": "every h > 0", "0": "no h > 0"}
        if limit in ends:
            click.echo(f"  bounded    for {ends[limit]}")
        else:
            reach = f"hω = {found.interval.decimal(_SHOWN)} with the greatest ω"
            least = plain(rational(limit or 0), _SHOWN)
            click.echo(f"  bounded    for 0 < h < {least}, until {reach}")
        if found.step_size_exact:
            click.echo(f"  exactly    {found.step_size_exact}")
        if found.interval.note:
            click.echo(f"  note       {found.interval.note}")
    for h, bounded in found.decided.items():
        click.echo(f"  h = {text(h):6} {_SAID[bounded]}")


def _frequencies(found: "LinearAtEquilibrium") -> str:
    each = [
        f.decimal(_SHOWN) + f" ({f.multiplicity} times)" * (f.multiplicity > 1)
        for f in found.frequencies
    ]
    if len(each) > _MOST_SHOWN:
        each = [each[0], each[1], "…", *each[-2:]]
    rest = "" if found.oscillates else "none for the other degrees of freedom"
    return ", ".join(filter(None, (*each, rest)))


if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.studies.kinds.stability import StabilityFindings

_PLAIN = ("stable", "drifts")  # verdicts that say all there is
_WIDTH, _IN = 100, " " * 6


@click.command()
@with_one_line(
    click.option("--steps", type=int, metavar="N", help="At least 1; or:"),
    click.option("--time", metavar="T", help="N is T/H rounded down."),
)
@start_options
@click.option(
    "--linear",
    is_flag=True,
    help="One scheme on the harmonic oscillator, or at an equilibrium of H, by algebra.",
)
@with_tasks
def stability(
    scene: str | None, linear: bool, keep: Path | None, where: "Placement", **given: Any
) -> Answer:
    """Judge the runs of SCENE: a TOML file, `paper`, or the suites `stiff` and `extreme`.

    stable, drifts, unstable: scheme, unstable: arithmetic, escapes, overflow at step k, underflow;
    in n degrees of freedom sensitive, where the exact motion parts from its neighbours itself.
    Nothing of the scene is done but its [[stability]], [[largest_step]], [[stability_map]] and
    [[orbit_map]].

    \b
    verify stability stiff
    verify stability --system pendulum --scheme lie2 --step-size 0.1 --time 100 --q 1 --p 0
    verify stability --linear --scheme lie4
    verify stability --linear --scheme rk4 --system fput --param n=8 --param alpha=1 --param beta=0
    """
    if linear:
        return linear_answer(scene, given)
    from verify.execution.study import plan_of
    from verify.scenes.values import rounded_down
    from verify.studies.kinds.stability import findings_of, need_stability

    scenes = scenes_of(scene, given, ("q", "p"), _section)
    plan = plan_of(scenes, need_stability)
    if not plan.tasks:
        problem = "asks for no [[stability]], [[largest_step]], [[stability_map]] or [[orbit_map]]"
        raise InputError("SCENE", scene or NOT_GIVEN, problem)
    found = findings_of(scenes, perform(plan, keep, where))
    notes = [
        rounded_down(section.time, section.step_sizes)
        for each in scenes
        for section in each.stability
    ]

    def shown() -> None:
        _print(found)
        print_once(notes)

    return Answer(found.as_json, shown)


def _section(*, q: Any, p: Any, **rest: Any) -> dict[str, Any]:
    return {"stability": [{**rest, "initial_values": [{"q": q, "p": p}]}]}


def _print(found: "StabilityFindings") -> None:
    width = max((len(run.verdict) for run in found.stability), default=0)
    for run in found.stability:
        click.echo(f"{run.verdict:{width}}  {run.id}")
        if run.kind not in _PLAIN:
            detail = textwrap.fill(run.detail, _WIDTH, initial_indent=_IN, subsequent_indent=_IN)
            click.echo(detail)
    for step in found.largest_steps:
        measured, detail = f"bounded up to h = {step.bounded}", str(step.detail)
        if step.bounded is None:
            measured = "never bounded"
        elif step.unbounded is None:
            measured, detail = f"{detail}, the largest h = {step.bounded},", ""
        linear = f"linear theory {step.linear}" if step.linear else "linear theory sets no limit"
        within = [f"energy error ≤ {step.energy_error}"] * bool(step.energy_error)
        within += [f"|W| ≤ {step.symplectic_defect}"] * bool(step.symplectic_defect)
        with_ = f" with {' and '.join(within)}" if within else ""
        said = f"{measured}{with_} until t = {step.time}; {linear}  {detail}"
        click.echo(f"{step.scheme}: {said}")
    for over in found.stability_maps:
        counted = ", ".join(f"{n} {kind}" for kind, n in over.counted().items())
        click.echo(f"{over.scheme}: {over.parameter} and step size: {counted}")
    for starts in found.orbit_maps:
        counted = ", ".join(f"{n} {kind}" for kind, n in starts.counted().items())
        click.echo(f"{starts.scheme}: orbits over {' and '.join(starts.axes)}: {counted}")
