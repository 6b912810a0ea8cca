"""Certificates of all kinds, and their exports for Rocq, each made once by a process."""

import contextlib
import io
import json
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

from tests.helpers.rocq.two_names import with_square
from verify.commands.main import cli
from verify.proof.assistant.certificate_export import ExportedFile, export_certificate
from verify.proof.certificates.certificate_file import FORMAT

_EVERY = "--every-hamiltonian"
_IN_TIME = ("--degrees", "2", "--time-dependent")
_TWO = "(p1**2 + p2**2)/2 + q1**2*q2 - q2**3/3"
_TWO_IN_TIME = "(p1**2 + p2**2)/2 + (a + t)*q1**2*q2"


def _system(name: str, scheme: str) -> list[str]:
    return ["--system", name, "--scheme", scheme]


def _hamiltonian(text: str, scheme: str) -> list[str]:
    return ["--hamiltonian", text, "--scheme", scheme]


def _every(scheme: str, *more: str) -> list[str]:
    return [_EVERY, *more, "--scheme", scheme]


# What `verify prove` is asked for, by the names of the exports' files: `EVERY` by derivatives of H,
# `ONE` of one H, `COEFFICIENTS` by the numbers of the scheme.
EVERY = {
    **{f"every_lie{eta}": _every(f"lie{eta}") for eta in range(2, 7)},
    "every_separable": _every("lie2", "--separable"),
    "every_in_time": _every("lie3", "--time-dependent"),
    "every_two": _every("lie2", "--degrees", "2"),
    "every_two_odd": _every("lie1", *_IN_TIME),
    "every_rk4": _every("rk4"),
}
ONE = {
    "duffing_lie2": _system("duffing", "lie2"),
    "duffing_rk4": _system("duffing", "rk4"),
    "duffing_stormer_verlet": _system("duffing", "stormer-verlet"),
    "pendulum_lie2": _system("pendulum", "lie2"),
    "pendulum_lie3": _system("pendulum", "lie3"),
    "driven_pendulum": _system("driven-pendulum", "lie2"),
    "henon_heiles": _hamiltonian(_TWO, "lie2"),
    "two_in_time": _hamiltonian(_TWO_IN_TIME, "lie2"),
    "quotient": _hamiltonian("p**2/2 - a/q", "lie2"),
    "functions": _hamiltonian("p**2/2 - 1/(1 + q**2) + exp(q)/3", "lie2"),
    "not_shown": _hamiltonian("p**2/2 - cos(q + 1/3)", "lie2"),
    "nested": _hamiltonian("p**2/2 - " + "sin(" * 20 + "q" + ")" * 20, "lie1"),
    "driven_kick": _hamiltonian("p**2/2 + t*q**4", "stormer-verlet"),
}
COEFFICIENTS = {
    "stormer_verlet": _every("stormer-verlet", "--separable"),
    "yoshida4": _every("yoshida4"),
    "yoshida4_in_time": _every("yoshida4", *_IN_TIME),
    "implicit_euler": _every("implicit-symplectic-euler", "--time-dependent"),
    "triple_jump6": _every("triple-jump6"),
    "midpoint": _every("implicit-midpoint"),
    "gauss4": _every("gauss4"),
    "gauss6": _every("gauss6", *_IN_TIME),
}
# What no scheme of ours has: kicks, which for every H are polynomials in h, weights that fit by the
# equation of a root alone, and two roots.
_KICK: dict[str, Any] = {
    "format": FORMAT,
    "hamiltonian": "every",
    "separable": True,
    "p_next": [[["1", "p"]], [["-1", "H_q"]]],
    "q_next": [[["1", "q"]]],
    "convergence_order": 0,
    "order": None,
    "leading": [],
}
_KICKS = {"p1": "q1", "p2": "q2"}
_KICK_OF_TWO: dict[str, Any] = {
    "format": FORMAT,
    "degrees": 2,
    "separable": True,
    "next": {p: [[["1", p]], [["-1", f"H_{q}"]]] for p, q in _KICKS.items()}
    | {q: [[["1", q]]] for q in _KICKS.values()},
    "convergence_order": 0,
    "order": None,
    "leading": [],
}
_OF_ONE: dict[str, Any] = {"parameters": [], "functions": [], "witness": {}, "cofactors": {}}
_RULE: dict[str, Any] = {"format": FORMAT, "hamiltonian": "every", "separable": False}
_ROOT_OF_2, _ROOT_OF_3 = ["w", ["-2", "0", "1"], "1", "2"], ["v", ["-3", "0", "0", "1"], "1", "2"]
_MINUS_1, _W, _V = ["-1"], ["1", "w"], ["1", "v"]
_HALF_W = ["1/2", "w"]
_WEIGHTS = [[_W, _MINUS_1], [_W]]
_SHARES = [[[_HALF_W, ["-1/2"]], [_W, ["1"]]], [[_HALF_W, _MINUS_1], [_HALF_W]]]
WRITTEN = {
    "every_kick": _KICK,
    "every_kick_of_two": _KICK_OF_TWO | {"hamiltonian": "every"},
    "kick_of_two": {k: v for k, v in _KICK_OF_TWO.items() if k != "separable"}
    | {"hamiltonian": [["1", "q1", "q2"]], **_OF_ONE}
    | {"next": {"p1": [[["1", "p1"]], [["-1", "q2"]]], "p2": [[["1", "p2"]], [["-1", "q1"]]],
                "q1": [[["1", "q1"]]], "q2": [[["1", "q2"]]]}},
    "fit_by_a_root": _RULE
    | {"numbers": [_ROOT_OF_2], "tableau": {"a": _SHARES, "b": _WEIGHTS}},
    "two_roots": _RULE
    | {"separable": True, "numbers": [_ROOT_OF_2, _ROOT_OF_3],
       "stages": [[[_W], [_V], "1/3", "2/3"]]},
}  # fmt: skip
# Where a function has two names, and what is 0 is seen to be so by both of their relations.
RENAMED = {
    "two_names": ("quotient", "inverse", [["1", "q", "q"]]),
    "two_names_of_sum": ("functions", "inverse", [["1"], ["2", "q", "q"], ["1", *"qqqq"]]),
}
ALL = {**EVERY, **ONE, **COEFFICIENTS, **WRITTEN, **RENAMED}


def certificate(name: str) -> dict[str, Any]:
    """The certificate of this name, as it is read from its file."""
    return json.loads(_text(name))  # type: ignore[no-any-return]


@cache
def _text(name: str) -> str:
    if name in RENAMED:
        of, kind, argument = RENAMED[name]
        data = certificate(of)
        old = next(own for own, its_kind, _ in data["functions"] if its_kind == kind)
        return json.dumps(with_square(data, old, "#99", argument))
    asked = {**EVERY, **ONE, **COEFFICIENTS}
    return json.dumps(WRITTEN[name] if name in WRITTEN else proved(asked[name]))


def proved(asked: list[str]) -> dict[str, Any]:
    """The certificate that `verify prove` writes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        command = ["prove", *asked, "--certificate", str(path)]
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            cli.main(command, standalone_mode=False)
        return json.loads(path.read_text(encoding="utf-8"))  # type: ignore[no-any-return]


@cache
def export(name: str, *, stands_alone: bool = False) -> ExportedFile:
    """That certificate's export, by default for what stands beside the theory."""
    return export_of(certificate(name), stands_alone=stands_alone)


def export_of(data: dict[str, Any], *, stands_alone: bool = False) -> ExportedFile:
    """The export of a certificate with these entries."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        return export_certificate(path, stands_alone=stands_alone)
