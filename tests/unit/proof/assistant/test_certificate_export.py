"""Exports as texts: they assume nothing, and no text of a certificate is read as a part of them."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.helpers.rocq.assumptions import assuming_words, without_comments
from tests.helpers.rocq.exports import ALL, certificate, export, export_of, proved
from verify.errors import InputError
from verify.proof.assistant.certificate_export import check_file_name
from verify.proof.assistant.rocq_formulas import safe_names
from verify.proof.assistant.text import render_file
from verify.proof.assistant.theorems_by_coefficients import export_stages
from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import Stages

HOSTILE = '*) Axiom a : False. (* " (** **) *)) "" ((* ' * 3


@pytest.mark.sample(12)
@pytest.mark.parametrize("name", ALL)
def test_an_export_assumes_nothing_and_tells_its_theorems(name: str) -> None:
    text = export(name).text
    assert assuming_words(text) == []
    told = [line.split()[1] for line in text.splitlines() if line.startswith("Theorem ")]
    assert tuple(theorem.rstrip(":") for theorem in told) == export(name).theorems != ()


@pytest.mark.parametrize("name", ["duffing_lie2", "every_two", "gauss4", "yoshida4_in_time"])
def test_what_stands_alone_assumes_nothing_and_ends_like_the_other(name: str) -> None:
    text = export(name, stands_alone=True).text
    assert assuming_words(text) == []
    assert "AreaPreservation Require" not in text
    shown = "(** * What is proved"
    assert text.split(shown)[1] == export(name).text.split(shown)[1]


@pytest.mark.parametrize(
    ("scheme", "same"), [("rk4", "every_rk4"), ("stormer-verlet", "stormer_verlet")]
)
def test_a_map_that_is_no_polynomial_has_the_export_for_every_h(scheme: str, same: str) -> None:
    found = proved(["--system", "pendulum", "--scheme", scheme])
    assert export_of(found).text == export(same).text


def test_no_text_that_is_told_ends_the_comment_it_stands_in() -> None:
    entries = check(certificate("yoshida4"))
    assert isinstance(entries, Stages)
    told = replace(
        export("yoshida4").facts,
        statement=HOSTILE,
        hamiltonian=HOSTILE,
        leading=HOSTILE,
        potential=HOSTILE,
        scheme=HOSTILE,
        domain=(HOSTILE,),
    )
    text = render_file(export_stages(entries), told, stands_alone=False)
    assert text.count("Axiom a") == 18
    assert text.count('"') == export("yoshida4").text.count('"')
    assert without_comments(text).split() == without_comments(export("yoshida4").text).split()


@pytest.mark.parametrize("key", ["scheme", "statement", "comment", HOSTILE])
def test_a_certificate_has_no_text_of_its_own(key: str) -> None:
    with pytest.raises(InputError, match="no entry of this name"):
        export_of({**certificate("duffing_lie2"), key: HOSTILE})


@pytest.mark.parametrize("name", ["d*)", "d'", "d d", "d.", "", "H_p", "(*", "п", "1d"])
def test_a_parameter_is_called_by_a_word(name: str) -> None:
    with pytest.raises(InputError, match="is no new name"):
        export_of({**certificate("duffing_lie2"), "parameters": [name]})


def test_what_the_small_checker_refuses_has_no_export() -> None:
    with pytest.raises(InputError, match="is refused: "):
        export_of({**certificate("duffing_lie2"), "order": 4})
    with pytest.raises(InputError, match="is refused: "):
        export_of({**certificate("gauss4"), "separable": 1})


def test_a_file_is_called_as_a_module() -> None:
    for name in ("lie2.v", "_.v", "A1_b.v"):
        check_file_name(Path("folder-1") / name)
    for name in ("lie2", "lie2-a.v", "1.v", "forall.v", ".v", "a b.v", "é.v", "a.v.v", "a.V"):
        with pytest.raises(InputError, match=r"ends in \.v"):
            check_file_name(Path(name))


def test_a_name_gets_an_apostrophe_where_it_is_a_word_or_what_another_is_called_to_be() -> None:
    found = safe_names(["x", "is_x", "w", "H", "Qed", "a"], ["a", "H"], ["is_"])
    assert found == {"x": "x", "is_x": "is_x'", "w": "w", "H": "H'", "Qed": "Qed'", "a": "a'"}
    assert safe_names(["fun", "is_fun"], [], ["is_"]) == {"fun": "fun'", "is_fun": "is_fun"}
    assert safe_names(["is_w", "w"], [], ["is_"]) == {"is_w": "is_w", "w": "w'"}
    assert safe_names(["x", "is_x"], ["x"], ["is_"]) == {"x": "x'", "is_x": "is_x"}
