"""One step of an argument on paper, with who checked it."""

from verify.scenes.frozen import Said, WithProse


class StepResult(WithProse):
    """A step in words and formulas.

    `checked_by`: what checked it by machine, one text each; where there is none it was not checked
    by machine. `tried`: examples of it that were computed, which prove nothing by themselves.
    """

    text: Said
    checked_by: tuple[Said, ...] = ()
    tried: tuple[Said, ...] = ()
