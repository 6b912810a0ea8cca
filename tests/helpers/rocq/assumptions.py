"""What a file for Rocq takes for granted: words that say so, and what `Print Assumptions` tells."""

import re
from collections.abc import Iterable, Iterator

# The standard library's, which stand behind its real numbers.
OF_THE_REALS = frozenset(
    {
        "ClassicalDedekindReals.sig_not_dec",
        "ClassicalDedekindReals.sig_forall_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
        "Classical_Prop.classic",
    }
)
_WORDS = (
    r"Axioms?",
    r"Parameters?",
    r"Hypothes[ie]s",
    r"Variables?",
    r"Conjectures?",
    r"Admitted",
    r"Admit Obligations",
    r"admit",
    r"give_up",
    r"Abort",
    r"Declare\s+(?:Module|ML|Instance)",
    r"Module\s+Type",
    r"Primitive",
    r"Unset\s+(?:Guard|Positivity|Universe)\s+Checking",
    r"bypass_check",
    r"type_in_type",
)
_ASSUMING = re.compile(rf"\b(?:{'|'.join(_WORDS)})\b")
_BEGUN = re.compile(r"^(Axioms:|Closed under the global context)$", re.MULTILINE)
ASKED = re.compile(r"^Print Assumptions (\w+)\.\n", re.MULTILINE)
_SENTENCE = re.compile(r"\b(Section|End|Context)\b\s*(\w*)")


def without_comments(text: str) -> str:
    """The text with each comment, also one with others within, made a blank."""
    kept, depth = [], 0
    for part in re.split(r"(\(\*|\*\))", text):
        if part == "(*":
            depth += 1
        elif part == "*)":
            depth -= 1
            assert depth >= 0, "a comment ends that has not begun"
            kept.append(" ")
        elif not depth:
            kept.append(part)
    assert depth == 0, "a comment does not end"
    return "".join(kept)


def assuming_words(text: str) -> list[str]:
    """The words by which the text takes something for granted, comments apart.

    `Context` in no section is one: there it is an axiom.
    """
    plain = without_comments(text)
    return [*_ASSUMING.findall(plain), *_contexts_in_no_section(plain)]


def _contexts_in_no_section(plain: str) -> Iterator[str]:
    sections: list[str] = []
    for word, name in _SENTENCE.findall(plain):
        if word == "Section":
            sections.append(name)
        elif word == "Context" and not sections:
            yield word
        elif word == "End" and sections and sections[-1] == name:
            sections.pop()


def asked_together(name: str, theorems: Iterable[str]) -> str:
    """Sentences by which Rocq prints what any of the theorems assumes: once for all of them.

    To print it of each would go through the library's real numbers again for each.
    """
    used = "".join(f"  let _ := @{x} in\n" for x in theorems)
    return f"\nDefinition {name} :=\n{used}  tt.\nPrint Assumptions {name}.\n"


def printed_assumptions(said: str) -> list[frozenset[str]]:
    """Of each `Print Assumptions` in order, the names of what is assumed."""
    before, *found = _BEGUN.split(said)
    assert not before.strip(), f"something else is printed: {before}"
    return [
        frozenset(line.split()[0] for line in told.splitlines() if line and not line[0].isspace())
        for told in found[1::2]
    ]
