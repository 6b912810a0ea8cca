"""What a file that stands alone needs of the theory: what nothing in it names is left out.

A file of the theory is a row of sentences; what they prove or define has a name. It stays where its
name is a word of something that stays and may mean it, whatever it does mean there: rather too much
stays than too little, and `coqc` has the last word. What works without being named, such
as notations, records and instances, always stays; what a section declares for itself goes with the
last that it is declared for.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

_WORD = re.compile(r"[A-Za-z_][\w']*")
_END_OF_SENTENCE = re.compile(r"\.(?=\s)")
_END_OF_PROOF = re.compile(r"\b(?:Qed|Defined)\.(?=\s)")
_COMMENT = re.compile(r"\(\*|\*\)")
_NAMED = re.compile(r"(?:Lemma|Theorem|Corollary|Definition|Fixpoint|Ltac)\s+([A-Za-z_][\w']*)")
_PROOF = re.compile(r"\s*Proof\b")
_IMPORT = re.compile(r"(?:From \w+ Require )?Import\b")
_SECTION = re.compile(r"Section (\w+)\.")
_OF_A_FILE = re.compile(r"Local\b")
_OF_A_SECTION = re.compile(r"(?:Section|End|Context|Let|Notation|Add Ring|Local|Implicit Types)\b")


@dataclass(frozen=True)
class Part:
    """A sentence with its proof, and the comment before it.

    `name`: of what it proves or defines, by which alone it is of use; `section`: the name of the
    one it stands in; `serves`: whether it is there for what else is in the file, or in its section.
    """

    text: str
    words: frozenset[str]
    name: str | None
    section: str | None
    serves: bool


def needed(files: Mapping[str, str], below: Mapping[str, Iterable[str]], by: str) -> dict[str, str]:
    """What the text `by` needs of these files, without those of which nothing is left.

    `below`: of each file those that it may name something of, itself among them.
    """
    parts = [(file, part) for file, text in files.items() for part in parts_of(text)]
    kept = [parts[k] for k in sorted(_kept(parts, below, words_of(without_comments(by))))]
    words = words_of(by).union(*(part.words for _, part in kept))
    stays = {file for file, part in kept if not part.serves} | (set(files) & words)
    return {
        file: "".join(part.text for of, part in kept if of == file)
        for file in files
        if file in stays
    }


def _kept(
    parts: Sequence[tuple[str, Part]], below: Mapping[str, Iterable[str]], by: Iterable[str]
) -> set[int]:
    """Those that stay, by their numbers."""
    kept: set[int] = set()
    named = {file: set(by) for file, _ in parts}  # words that may mean something of the file
    in_use: set[tuple[str, str | None]] = set()  # files, and sections in them

    def stays(file: str, part: Part) -> bool:
        if part.name is not None:
            return part.name in named[file]
        return not part.serves or (file, part.section) in in_use

    while found := {k for k, each in enumerate(parts) if k not in kept and stays(*each)}:
        kept |= found
        for file, part in map(parts.__getitem__, found):
            for under in below[file]:
                named[under] |= part.words
            if not part.serves:
                in_use |= {(file, None), (file, part.section)}
    return kept


@cache
def parts_of(text: str) -> tuple[Part, ...]:
    """The file in parts, whose texts follow one another in it."""
    found: list[Part] = []
    plain, begin, section = without_comments(text), 0, None
    for end in _ends(plain):
        sentence = plain[begin:end].strip()
        if section is None and (opened := _SECTION.match(sentence)):
            section = opened[1]
        found.append(_part(text[begin:end], sentence, section))
        if sentence == f"End {section}.":
            section = None
        begin = end
    return (*found, Part(text[begin:], frozenset(), None, None, serves=True))


def _part(text: str, sentence: str, section: str | None) -> Part:
    named, imports = _NAMED.match(sentence), _IMPORT.match(sentence)
    serving = _OF_A_FILE if section is None else _OF_A_SECTION
    words = frozenset() if imports else words_of(sentence)
    serves = bool(imports or serving.match(sentence))
    return Part(text, words, named[1] if named else None, section, serves)


def _ends(plain: str) -> Iterator[int]:
    """Where the sentences end, those that a proof follows with their proofs."""
    at = 0
    while found := _END_OF_SENTENCE.search(plain, at):
        at = found.end()
        if _PROOF.match(plain, at):
            proof = _END_OF_PROOF.search(plain, at)
            at = proof.end() if proof else len(plain)
        yield at


def words_of(plain: str) -> frozenset[str]:
    """The words of a text without comments, any of which may be a name."""
    return frozenset(_WORD.findall(plain))


def without_comments(text: str) -> str:
    """The text with blanks in the place of its comments, of which some stand within others."""
    pieces, depth, begin = [], 0, 0
    for found in _COMMENT.finditer(text):
        opens = found[0] == "(*"
        depth += 1 if opens else -1
        if opens and depth == 1:
            pieces.append(text[begin : found.start()])
            begin = found.start()
        elif depth == 0:
            pieces.append(re.sub(r"[^\n]", " ", text[begin : found.end()]))
            begin = found.end()
    return "".join([*pieces, text[begin:]])
