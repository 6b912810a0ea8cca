"""Derivatives of a program's values, of what its equations are solved for among them."""

import random
from fractions import Fraction

import flint
import pytest

from verify.kernels.step.kinds import Op
from verify.kernels.step.matrix_operations import eliminate
from verify.kernels.step.operations import StepProgram


def run(program: StepProgram, inputs: dict[str, Fraction]) -> list[Fraction]:
    values: list[Fraction] = []

    def made(op: Op) -> Fraction:
        x = [values[k] for k in op.args]
        match op.kind:
            case "input":
                return inputs[op.name]
            case "const":
                return op.value
            case "add":
                return x[0] + x[1]
            case "sub":
                return x[0] - x[1]
            case "mul":
                return x[0] * x[1]
            case "neg":
                return -x[0]
            case "inverse":
                return 1 / x[0]
        raise AssertionError(op.kind)

    for op in program.ops:
        values.append(made(op))
    return values


@pytest.mark.parametrize("size", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", range(3))
def test_the_solution_is_that_of_the_system(size: int, seed: int) -> None:
    draw, program = random.Random(f"{size} {seed}"), StepProgram()  # noqa: S311 - no secret
    unused = program.input("unused", static=False)  # so that no value of ours has the index 0
    assert unused == 0

    def value(name: str) -> tuple[int, Fraction]:
        exact = Fraction(draw.randint(-9, 9), 40) + (name[0] == "m" and name[1] == name[2])
        inputs[name] = exact
        return program.input(name, static=False), exact

    inputs = {"unused": Fraction(10**6)}
    matrix = [[value(f"m{i}{j}") for j in range(size)] for i in range(size)]
    right = [value(f"r{i}") for i in range(size)]
    twice = [[at, program.add(at, at)] for at, _ in right]
    rows, pivots = eliminate(program, [[at for at, _ in row] for row in matrix], twice)
    values = run(program, inputs)
    for column, factor in ((0, 1), (1, 2)):
        solved = [values[row[column]] for row in rows]
        for row, (_, wanted) in zip(matrix, right, strict=True):
            assert sum(x * y for (_, x), y in zip(row, solved, strict=True)) == factor * wanted
    product = Fraction(1)
    for at in pivots:
        product *= values[at]
    entries = [flint.fmpq(x.numerator, x.denominator) for row in matrix for _, x in row]
    det = flint.fmpq_mat(size, size, entries).det()
    assert product == Fraction(int(det.p), int(det.q))
