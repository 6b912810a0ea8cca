"""Why a text is not TOML: the mistake in the line where the reader stopped."""

import re
import unicodedata

_AT_LINE = re.compile(r"at line (\d+)")
_BARE = re.compile(r"""\s*([A-Za-z0-9_.-]+)\s*=\s*([^\s"'\[{#][^#,}\]]*)""")
_QUOTES = frozenset("“”„‘’«»")
_LONGEST = 40  # characters of what is quoted


def toml_mistake(content: str, problem: str) -> str:
    """The reader's problem, and what to write where the mistake is a known one."""
    found = _AT_LINE.search(problem)
    lines = content.splitlines()
    line = lines[int(found[1]) - 1] if found and 0 < int(found[1]) <= len(lines) else ""
    hint = _hint(content, line, problem)
    return f"is not TOML: {problem}{hint and '; ' + hint}"


def _hint(content: str, line: str, problem: str) -> str:
    if content.startswith("\ufeff"):
        return "it begins with a byte-order mark; save it as UTF-8 without one"
    if content.lstrip().startswith("{"):
        return 'this is JSON; write lines such as: system = "pendulum"'
    foreign = next((c for c in line if c in _QUOTES), None)
    if foreign:
        return f'write " for {foreign} ({unicodedata.name(foreign).lower()})'
    if re.match(r"\s*(import|from|def|class|#include|using)\b", line):
        return 'this is a program; a scene is a file of lines such as: system = "pendulum"'
    if re.match(r"\s*[A-Za-z0-9_-]+\s*:", line):
        return "write = for :"
    if re.search(r"\d,\d", line):
        return "write a decimal with a point, as 0.5"
    if "=" not in line and "key" in problem:
        return 'every line is a key with its value, such as: system = "pendulum"'
    if re.search(r"[,;]\s*$", line) and "newline" in problem:
        return "leave out what stands after the value"
    if "overwrite" in problem:
        return "the key stands twice; leave one out"
    bare = _BARE.match(line)
    if not bare:
        return ""
    key, value = bare[1], bare[2].strip()[:_LONGEST]
    if value in ("True", "False"):
        return f"write {key} = {value.lower()}"
    return f'write a text in quotation marks: {key} = "{value}"'
