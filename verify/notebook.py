"""How results show themselves in a notebook: plain tables, readable on any background.

HTML without a style sheet, a colour or a script; everything is escaped. LaTeX is made of formulas
and numbers only.
"""

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verify.proof.order import Proof
    from verify.scenes.results.core import (
        CrossoverResult,
        EvaluationResult,
        RunResult,
        SeparationGrid,
        SeparationResult,
        Value,
    )
    from verify.scenes.results.report import Report

_LONGEST = 1200  # characters of a formula that is shown
_RUN = {
    "lambda": ("Λ", r"\Lambda"),
    "lambda_plain": ("Λ, the plain way", r"\Lambda_{\text{plain}}"),
    "lambda_max": ("max |Λ|", r"\max |\Lambda|"),
    "mse": ("MSE", r"\text{MSE}"),
    "delta_j_max": ("max |ΔJ|", r"\max |\Delta J|"),
    "q": ("q", "q"),
    "p": ("p", "p"),
}
_PARTS = {
    "lambda_working": "Λ in float64",
    "truncation": "truncation",
    "total": "rounding",
    "input": "– input",
    "trajectory": "– trajectory",
    "determinant": "– determinant",
    "product": "– product",
}
_WAYS = {"plain": "the plain way", "closed_form": "closed form"}


# -- proofs ---------------------------------------------------------------------------------------


def proof_html(proof: "Proof") -> str:
    """Verdict, order, leading coefficient, closed form, witness, order of the map."""
    from verify.arithmetic.exact import text

    closed = proof.step_map.delta_j_text
    rows = [("verdict", f"{proof.verdict}: {proof.reason}")]
    if proof.area_preserving:
        rows.append(("area", "det J ≡ 1: the map preserves area exactly"))
    if proof.order is not None:
        at = ", ".join(f"{name} = {text(value)}" for name, value in proof.witness.items())
        rows += [
            ("order of ΔJ", str(proof.order)),
            ("leading coefficient", _cut(proof.first.text)),
            (f"its value at {at or 'any point'}", proof.enclosure),
        ]
    rows.append(("ΔJ in closed form", "too large; left out" if closed is None else _cut(closed)))
    order = proof.convergence_order
    agrees = "agrees with the exact flow in every power of h looked at" if order is None else order
    rows.append(("order of the map", str(agrees)))
    return _table("Proof", (), rows)


def proof_latex(proof: "Proof") -> str:
    """ΔJ by its leading term and in closed form; det J ≡ 1 where that is proved."""
    from sympy import latex

    lines = []
    if proof.area_preserving:
        lines.append(r"\det J &\equiv 1")
    if proof.order is not None:
        n = proof.order
        power = "h" if n == 1 else f"h^{{{n}}}"
        lead = _short(latex(proof.leading))
        lines.append(rf"\Delta J &= \left({lead}\right) {power} + O(h^{{{n + 1}}})")
    closed = proof.delta_j
    if closed is not None and not proof.area_preserving:
        lines.append(rf"\Delta J &= {_short(latex(closed))}")
    if not lines:
        lines.append(r"\Delta J &= \text{undecided}")
    return _aligned(lines)


def _short(formula: str) -> str:
    """A formula's LaTeX cannot be cut; one that is too long is left out."""
    return formula if len(formula) <= _LONGEST else r"\text{(too long to be shown)}"


def _aligned(lines: Iterable[str]) -> str:
    return r"$$\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}$$"


# -- runs -----------------------------------------------------------------------------------------


def run_html(run: "RunResult") -> str:
    """The values, each with its error bound."""
    caption = (
        f"{run.scheme}: {run.steps} steps of h = {run.step_size} from q = {run.q}, p = {run.p}"
    )
    foot = f"{run.arithmetic}, {run.digits} digits; bounds {run.error_kind}: {run.error_method}"
    if run.fallback:
        foot += f"; taken instead of what was asked for: {run.fallback}"
    if run.status != "finished":
        at = f" at step {run.failed_step}" if run.failed_step is not None else ""
        return _table(caption, (), [("outcome", run.status + at)], foot)
    rows = [
        (label, value.value, f"± {value.bound}")
        for name, (label, _) in _RUN.items()
        if (value := run.values.get(name))
    ]
    return _table(caption, ("", "value", "error bound"), rows, foot)


def run_latex(run: "RunResult") -> str:
    """The values with their error bounds."""
    lines = [
        f"{symbol} &= {_number(value.value)} \\pm {_number(value.bound)}"
        for name, (_, symbol) in _RUN.items()
        if (value := run.values.get(name))
    ]
    return _aligned(lines or [rf"\Lambda &: \text{{{run.status}}}"])


def _number(text: str) -> str:
    """`-1.2e-05` → −1.2 · 10⁻⁵."""
    mantissa, _, exponent = text.lower().partition("e")
    power = int(exponent or 0)
    return rf"{mantissa} \cdot 10^{{{power}}}" if power else mantissa


# -- separations ----------------------------------------------------------------------------------


def separation_html(point: "SeparationResult") -> str:
    """The parts of Λ for each way to evaluate it, with their bounds."""
    caption = f"{point.scheme}: {point.steps} steps of h = {point.step_size}, Λ in float64"
    if point.plain is None:
        return _table(caption, (), [(point.status, point.reason)])
    ways = {way: label for way, label in _WAYS.items() if getattr(point, way)}
    rows = [
        (label, *(_bounded(getattr(getattr(point, way).parts, name)) for way in ways))
        for name, label in _PARTS.items()
    ]
    rows.append(("rounding with N", *(getattr(point, way).growth["total"].name for way in ways)))
    foot = f"{point.arithmetic} as exact arithmetic; bounds {point.plain.error_kind}: "
    return _table(caption, ("", *ways.values()), rows, foot + point.error_method)


def grid_html(grid: "SeparationGrid") -> str:
    """Truncation and rounding of each step size, and where they cross; one alone in full."""
    if len(grid.points) == 1:
        return separation_html(grid.points[0])
    heads = ("h", "N", "truncation", *(f"rounding, {label}" for label in _WAYS.values()))
    rows = [(point.step_size, str(point.steps), *_sizes(point)) for point in grid.points]
    crossed = (f"{label}: {_crossing(getattr(grid, way))}" for way, label in _WAYS.items())
    foot = "rounding overtakes truncation, " + "; ".join(crossed)
    return _table("Truncation and rounding in Λ", heads, rows, foot)


def _sizes(point: "SeparationResult") -> Iterator[str]:
    if point.plain is None:
        yield f"{point.status}: {point.reason}"
        return
    yield _bounded(point.plain.parts.truncation)
    for way in (point.plain, point.closed_form):
        yield _rounding(way)


def _rounding(way: "EvaluationResult | None") -> str:
    return _bounded(way.parts.total) if way else "–"


def _bounded(value: "Value") -> str:
    return value.value if value.bound == "0" else f"{value.value} ± {value.bound}"


def _crossing(way: "CrossoverResult") -> str:
    return f"below h = {way.step_size}" if way.step_size else way.reason


# -- reports --------------------------------------------------------------------------------------


def report_html(report: "Report") -> str:
    """How many claims have which verdict, then each claim, the refuted ones first."""
    from verify.verdict import Verdict

    if not report.claims:
        rows = [
            (scene.title, proof.scheme, str(proof.verdict), proof.reason)
            for scene in report.scenes
            for proof in scene.proofs
        ]
        return _table(report.title, ("scene", "scheme", "verdict", "reason"), rows)
    claims = sorted(report.claims, key=lambda claim: claim.verdict is not Verdict.REFUTED)
    counts = ((v, sum(c.verdict is v for c in claims)) for v in Verdict)
    rows = [(str(c.verdict), c.source, c.id, c.evidence) for c in claims]
    foot = ", ".join(f"{n} {v.lower()}" for v, n in counts if n)
    return _table(report.title, ("verdict", "source", "claim", "evidence"), rows, foot)


# -- tables ---------------------------------------------------------------------------------------


def _cut(formula: str) -> str:
    if len(formula) <= _LONGEST:
        return formula
    return f"{formula[:_LONGEST].rsplit(' ', 2)[0]} …"


def _table(
    caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], foot: str = ""
) -> str:
    """The first column names the rows; all is text. Left, as words read; digits line up."""
    parts = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if heads:
        cells = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
        parts.append(f"<thead><tr>{cells}</tr></thead>")
    parts.append("<tbody>")
    for name, *values in rows:
        cells = "".join(f'<td style="{_CELL}">{escape(value)}</td>' for value in values)
        parts.append(f'<tr><th scope="row" style="{_CELL}">{escape(name)}</th>{cells}</tr>')
    parts.append("</tbody></table>")
    if foot:
        parts.append(f"<p>{escape(foot)}</p>")
    return "".join(parts)


_CELL = "text-align: left; font-variant-numeric: tabular-nums"
