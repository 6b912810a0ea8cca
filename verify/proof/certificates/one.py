"""The certificate of a proof for one H: its identities, with the cofactors that show them.

Derivatives are taken as the checker takes them, without reducing, so that what has to be zero is
the same polynomial here and there.
"""

import math
from collections.abc import Iterator, Mapping
from fractions import Fraction

import sympy

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.coordinates import PLANE
from verify.proof.certificates.by_coefficients import terms
from verify.proof.certificates.checker import see_witness
from verify.proof.certificates.every import map_of
from verify.proof.certificates.file import FORMAT, Certificate
from verify.proof.order_proof import Proof
from verify.proof.potential import Potential
from verify.verdict import Verdict

_TRIED = 20  # points
_KINDS = ("sin", "cos", "exp", "inverse")


def of_one(proof: Proof, potential: Potential) -> Certificate:
    """The certificate of a proof for one H.

    Raises InputError where nothing is proved, where the map is not a polynomial in h, and where H
    needs other functions than sin, cos, exp and denominators.
    """
    step_map = proof.step_map
    hamiltonian = step_map.hamiltonian
    if proof.verdict is not Verdict.PROVED or proof.convergence_order is None:
        raise InputError("proof", proof.verdict.value, "there is nothing to certify")
    if proof.convergence_order < 0:
        raise InputError("map", str(step_map.p_next), "is not (p, q) at h = 0: no certificate")
    if step_map.flat.degree is None or (proof.order is None) != (proof.area_preserving is True):
        raise InputError("map", str(step_map.p_next), "is no polynomial in h: no certificate")
    asked = [
        hamiltonian.exact,
        *step_map.composed,
        proof.leading,
        potential.potential or sympy.S.Zero,
    ]
    field, elements = hamiltonian.field(*asked)
    plain = Plain(field.ring, PLANE)
    _, p_next, q_next, leading, _ = elements
    h = plain.without_constants(elements[0])
    potential_ = plain.without_constants(elements[4], plain.variables)
    needed = max(proof.order or 0, proof.convergence_order) if proof.order else None
    series = [_coefficients(plain.ring, x)[: needed and needed + 1] for x in (p_next, q_next)]
    data = {
        "format": FORMAT,
        "hamiltonian": terms(h, plain.names),
        **({"time_dependent": True} if field.timed else {}),
        "parameters": [n for n in field.ring.variables if n not in ("p", "q", "h", "t")],
        "functions": plain.functions,
        **map_of(
            proof.order, proof.convergence_order, leading, (series[0], series[1]), plain.names
        ),
        "cofactors": {},
    }
    if proof.order is not None and potential.potential is not None:
        data["potential"] = terms(potential_, plain.names)
    data["witness"] = witness_of(data, PLANE, proof.witness)
    data["cofactors"] = {
        what: plain.cofactors(x)
        for what, x in _zeros(plain, data, h, series, leading, potential_)
        if not x.is_zero()  # what is zero as it stands has none
    }
    return data


def witness_of(
    data: Certificate, coordinates: tuple[str, ...], known: Mapping[str, Fraction]
) -> dict[str, str]:
    """A point at which the checker sees what is not 0: the proof's own, or one that is tried."""
    timed = ("t",) if data.get("time_dependent") else ()
    names = (*coordinates, *timed, *data["parameters"])
    for k in range(_TRIED):
        tried = {name: Fraction(7 + 4 * k + i, 17 + 2 * i) for i, name in enumerate(names)}
        at = {name: str(known.get(name, value)) for name, value in tried.items()}
        for witness in ({}, at):
            try:
                see_witness(data | {"witness": witness})
            except ValueError:
                continue
            return witness
    raise InputError(
        "proof", NOT_GIVEN, "no certificate: no point is found where no denominator is 0"
    )


def _coefficients(ring: Ring, x: Poly) -> list[Poly]:
    """Those of h⁰, h¹, … of a polynomial in h."""
    powers = ring.powers(x, "h")
    return [powers.get(n, ring.zero) for n in range(max(powers, default=0) + 1)]


class Plain:
    """A ring's polynomials with derivatives by the coordinates and t by the chain rule, and nothing
    reduced."""

    def __init__(self, ring: Ring, coordinates: tuple[str, ...]) -> None:
        self.ring, self.coordinates = ring, coordinates
        self.variables = (*coordinates, *("t",) * ("t" in ring.variables))
        self.names = {
            g.index: g.name if g.kind == "variable" else f"#{g.index}" for g in ring.generators
        }
        made = [g for g in ring.generators if g.kind != "variable"]
        for g in made:
            if g.kind not in _KINDS:
                raise InputError(
                    "hamiltonian",
                    ring.text(ring.context.gens()[g.index]),
                    "no certificate: it takes sin, cos, exp, denominators",
                )
        self.functions = [[self.names[g.index], g.kind, terms(g.inner, self.names)] for g in made]
        self._images: dict[int, dict[str, Poly]] = {}
        gens = ring.context.gens()
        for g in made:
            own = gens[g.index]
            partner = {"sin": "cos", "cos": "sin"}.get(g.kind)
            side = (partner and ring.find(partner, g.inner)) or ring.zero
            slope = {"sin": side, "cos": -side, "exp": own, "inverse": -(own**2)}[g.kind]
            self._images[g.index] = {by: slope * self.diff(g.inner, by) for by in self.variables}

    def diff(self, x: Poly, by: str) -> Poly:
        total = x.derivative(self.ring.room + self.ring.variables.index(by))
        degrees = x.degrees()
        for index, image in self._images.items():
            if degrees[index] > 0:
                total += x.derivative(index) * image[by]
        return total

    def without_constants(self, x: Poly, variables: tuple[str, ...] = ()) -> Poly:
        """Without the terms that depend on none of these variables, or of the coordinates."""
        variables = variables or self.coordinates
        terms = {m: c for m, c in terms_of(x) if any(self._has(m, by) for by in variables)}
        return self.ring.context.from_dict(terms)

    def _has(self, monomial: tuple[int, ...], by: str) -> bool:
        term = self.ring.context.from_dict({monomial: 1})
        return not self.diff(term, by).is_zero()

    def cofactors(self, x: Poly) -> dict[str, list[list[str]]]:
        """By which Σ cofactor·relation is x; InputError where reducing does not end at 0."""
        found: dict[int, Poly] = {}
        for index, power, relation in reversed(self.ring.relations):
            if x.degrees()[index] >= power:
                quotient, x = divmod(x, relation)
                found[index] = found.get(index, self.ring.zero) + quotient
        if not x.is_zero():
            raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
        return {self.names[index]: terms(c, self.names) for index, c in found.items()}


def _zeros(
    plain: Plain,
    data: Certificate,
    h: Poly,
    series: list[list[Poly]],
    leading: Poly,
    potential: Poly,
) -> Iterator[tuple[str, Poly]]:
    """What has to be zero, each by its name in the checker's words."""
    ring, order = plain.ring, data["order"]
    h_p, h_q = plain.diff(h, "p"), plain.diff(h, "q")

    def along_flow(y: Poly) -> Poly:
        slope = h_p * plain.diff(y, "q") - h_q * plain.diff(y, "p")
        return slope + plain.diff(y, "t") if "t" in plain.variables else slope

    last = order or sum(map(len, series))
    for by, own in zip("pq", series, strict=True):
        flow = ring.variable(by)
        for n in range(data["convergence_order"] + 1):
            yield f"{by} {n}", (own[n] if n < len(own) else ring.zero) - flow / math.factorial(n)
            flow = along_flow(flow)
    slopes = [
        [(plain.diff(x, "p"), plain.diff(x, "q")) for x in own] + [(ring.zero, ring.zero)] * last
        for own in series
    ]
    for n in range(1, last + 1):
        det = ring.zero - leading if n == order else ring.zero
        for k in range(n + 1):
            (p_p, p_q), (q_p, q_q) = slopes[0][k], slopes[1][n - k]
            det += p_p * q_q - p_q * q_p
        yield f"det {n}", det
    if "potential" in data:
        yield "potential", along_flow(potential) - leading
