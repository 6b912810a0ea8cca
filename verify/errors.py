"""The one error a user's input can cause."""


class InputError(ValueError):
    """Bad input: one line that names the input, its value and what is allowed.

    The command line turns it into exit status 2; nothing has been computed when it is raised.
    """

    def __init__(self, name: str, value: object, problem: str) -> None:
        self.name = name
        self.value = value
        self.problem = problem
        super().__init__(f"{name}={_short(value)}: {problem}")


def _short(value: object) -> str:
    """The value as one short line, however long or many-lined the user's text was."""
    text = value if isinstance(value, str) else repr(value)
    text = " ".join(text.split())
    return f"{text[:77]}…" if len(text) > 78 else text
