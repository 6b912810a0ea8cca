"""Reference data in n degrees of freedom as tables of texts.

The start is q0_1 … q0_n, p0_1 … p0_n, the state p1 … pn, q1 … qn, each with its radius.
"""

from collections.abc import Iterator

from verify.reference.make.cells import Row, cell
from verify.reference.make.models_in_degrees import (
    OF_ORBIT,
    DataInDegrees,
    FlowInDegrees,
    RunInDegrees,
    values_in_degrees,
)

_OF_ORBIT: Row = ("step", "status", "failed_step", "kind")
_OF_FLOW: Row = ("step", "time", "status", "kind")


def start_columns(degrees: int) -> Row:
    """The names of the columns that hold the start."""
    return tuple(f"{letter}0_{k}" for letter in "qp" for k in range(1, degrees + 1))


def state_columns(degrees: int) -> Row:
    """The names of those that hold the state: p1 … pn, q1 … qn."""
    return tuple(f"{letter}{k}" for letter in "pq" for k in range(1, degrees + 1))


def tables_in_degrees(data: DataInDegrees) -> dict[str, list[Row]]:
    """As `verify.reference.make.writing.tables`."""
    state = state_columns(data.degrees)
    return {
        f"{data.name}-proofs": list(_proof_rows(data)),
        f"{data.name}-runs": list(_rows(data, data.runs, ("scheme",), _OF_ORBIT,
                                        (*state, *OF_ORBIT))),
        f"{data.name}-flow": list(_rows(data, data.flow, (), _OF_FLOW, state)),
    }  # fmt: skip


def _proof_rows(data: DataInDegrees) -> Iterator[Row]:
    """An entry of the leading coefficient stands as NAME: FORMULA, entries between semicolons."""
    names = ("scheme", "verdict", "symplectic", "area_preserving", "order", "leading",
             "convergence_order")  # fmt: skip
    yield ("hamiltonian", "parameters", *names)
    given = "; ".join(f"{name} = {value}" for name, value in data.parameters.items())
    for proof in data.proofs:
        found = proof.model_dump(mode="json")
        found["leading"] = "; ".join(f"{at}: {x}" for at, x in proof.leading.items())
        yield (data.hamiltonian, given, *(cell(found[name]) for name in names))


def _rows(
    data: DataInDegrees,
    tables: tuple[RunInDegrees | FlowInDegrees, ...],
    named: Row,
    told: Row,
    numbers: Row,
) -> Iterator[Row]:
    time: Row = ("t0",) if data.timed else ()
    pairs = (x for name in numbers for x in (name, f"{name}_radius"))
    yield (*named, "step_size", *start_columns(data.degrees), *time, "digits", *told, *pairs)
    for of in tables:
        inputs = [
            *(cell(getattr(of, name)) for name in named),
            of.step_size,
            *of.q,
            *of.p,
            *(cell(getattr(of, name)) for name in (*time, "digits")),
        ]
        for row in of.rows:
            values = values_in_degrees(row, data.degrees).values()
            cells = (x for v in values for x in ((v.value, v.radius) if v else ("", "")))
            yield (*inputs, *(cell(getattr(row, name)) for name in told), *cells)
