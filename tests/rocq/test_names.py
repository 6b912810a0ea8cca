"""Names of parameters and numbers hide no word of Rocq, of the theory or of an export."""

import re
from collections.abc import Sequence
from typing import Any

import pytest

from tests.helpers.rocq.assumptions import ASKED
from tests.helpers.rocq.exports import certificate, export, export_of, proved
from tests.helpers.rocq.session import Session
from verify.proof.assistant.rocq_formulas import KEYWORDS, safe_names
from verify.proof.assistant.text import template_words

pytestmark = pytest.mark.left_to_ci

_NAME = re.compile(r"(?!H_)[A-Za-z][A-Za-z0-9_]*")
_GRAMMARS = ("constr", "tactic", "vernac", "pattern")
# Words of Rocq, of its library, of the theory, and of what an export is made of.
PARAMETERS = [
    "fun", "let", "exists2", "Variable", "forall", "Prop", "match", "Fixpoint", "R", "H", "s",
    "Rabs", "in_powers", "names", "nat", "list", "value", "point", "entry", "Name", "Number",
    "energy", "L", "G", "p_next", "nth", "pow", "IZR", "exact", "Qed", "x", "T", "w", "C", "moved",
]  # fmt: skip
NUMBERS = ("fun", "scheme", "x", "is_x", "w", "is_w", "there_is_w", "is_is_w")


def test_no_word_of_the_grammar_stands_for_a_parameter(rocq: Session) -> None:
    """As it is written, which is another way where coqc takes the word for one of its own."""
    loaded = "".join(re.findall(r"^From [^.]*\.\n", export("pendulum_lie2").text, re.MULTILINE))
    asked = "".join(f"Print Grammar {name}.\n" for name in _GRAMMARS)
    said = rocq.accepted(loaded + asked)
    words = sorted(set(re.findall(r"\w+", said)) | KEYWORDS)
    assert {"forall", "exists2", "Fixpoint", "symmetry", "match"} <= set(words)
    spelled = safe_names(filter(_NAME.fullmatch, words), ()).values()
    text = "".join(f"Check (fun {name} : R => {name} + 1)%R.\n" for name in spelled)
    rocq.accepted(loaded + text)


def test_parameters_may_be_called_by_words_of_rocq_and_of_the_export(
    rocq: Session,
) -> None:
    assert {"fun", "exists2", "match"} <= set(PARAMETERS) & KEYWORDS
    assert {"H", "in_powers", "names"} <= set(PARAMETERS) & template_words("one")
    data = proved(["--hamiltonian", "p**2/2 + mass*q**4/4", "--scheme", "lie2"])
    of_sum = with_sum_of(PARAMETERS, data)
    of_sum["witness"] = {"p": "1", "q": "1", **dict.fromkeys(PARAMETERS, "1")}
    rocq.accepted(ASKED.sub("", export_of(of_sum).text))


def with_sum_of(names: Sequence[str], entry: Any) -> Any:
    """A certificate's entry with the sum of these in the place of `mass`, of no higher power."""
    if isinstance(entry, dict):
        return {key: with_sum_of(names, inner) for key, inner in entry.items()}
    if entry == ["mass"]:
        return list(names)
    if not isinstance(entry, list):
        return entry
    terms = ([inner] if "mass" not in inner else _each(names, inner) for inner in entry)
    return [with_sum_of(names, term) for each in terms for term in each]


def _each(names: Sequence[str], term: Any) -> list[Any]:
    """The term once for each name; the list of the parameters stays as it is."""
    if term == "mass" or not isinstance(term, list):
        return [term]
    assert term.count("mass") == 1
    return [[name if factor == "mass" else factor for factor in term] for name in names]


def test_numbers_may_be_called_by_words_of_rocq_and_of_the_export(
    rocq: Session,
) -> None:
    data: dict[str, Any] = certificate("two_roots")
    data["numbers"] = [[name, *data["numbers"][0][1:]] for name in NUMBERS]
    data["stages"] = [[[["1", name]], [["1", name]], "1/3", "2/3"] for name in NUMBERS]
    rocq.accepted(ASKED.sub("", export_of(data).text))
