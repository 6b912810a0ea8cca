"""A certificate's file, checked: what it says where it holds, and else why it is refused."""

from pathlib import Path
from typing import Any

from verify.formats import read_json
from verify.proof.certificates.checker import check

FORMAT = "areaproof certificate 1"
Certificate = dict[str, Any]  # as JSON has it; who reads it takes nothing for granted


def checked(path: Path) -> tuple[bool, str]:
    """(whether it holds, its statement or why not); InputError where it is no such certificate.

    `verify.proof.certificates.checker` takes data without looking at their format.
    """
    data = read_json(path, FORMAT)
    try:
        check(data)
        return True, statement(data)
    except ValueError as reason:
        return False, str(reason)
    except (LookupError, TypeError, AttributeError, ArithmeticError, StopIteration) as error:
        return False, f"an entry is missing or malformed ({type(error).__name__}: {error})"
    except RecursionError:
        return False, "its functions are nested too deeply"


def statement(data: Certificate) -> str:
    """What the certificate says, from the entries that the checker looks at."""
    every = "every smooth H = T(p) + V(q)" if data.get("separable") else "every smooth H"
    where = every if data["hamiltonian"] == "every" else "the H that it holds"
    if "stages" in data:
        return f"det J = 1 for {where} and the scheme of its stages"
    order, agreed = data["order"], data["convergence_order"]
    generic = " for a generic H" if data["hamiltonian"] == "every" else ""
    area = "det J = 1"
    if order is not None:
        area = f"det J − 1 = L h^{order} + O(h^{order + 1}), L not zero{generic}"
    telescopes = "; L = X·G" if data.get("potential") is not None else ""
    flow = f"which agrees with the flow up to h^{agreed}"
    return f"{area}, for {where} and the map that it holds, {flow}{telescopes}"
