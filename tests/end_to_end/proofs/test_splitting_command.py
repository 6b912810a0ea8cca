"""`verify prove --every-hamiltonian` of schemes that are proved by their coefficients."""

import pytest

from tests.end_to_end.test_command_line import here, json_of

EVERY = ("prove", "--every-hamiltonian", "--scheme")


@pytest.mark.parametrize(("name", "order", "count"), [("blanes-moan4", 4, 8), ("ruth3", 3, 5)])
def test_order_area_and_every_condition_are_told(
    capsys: pytest.CaptureFixture[str], name: str, order: int, count: int
) -> None:
    found = json_of(here(capsys, *EVERY, name, "--json")[1])
    assert (found["verdict"], found["convergence_order"]) == ("PROVED", order)
    assert (found["area_preserving"], found["delta_j"], found["order"]) == (True, "0", None)
    assert found["hamiltonian"] == "every smooth H = T(p) + V(q)"
    orders = [condition["order"] for condition in found["conditions"]]
    assert len([n for n in orders if n]) == count
    assert max(orders) == order
    assert orders.count(0) == 2, "the determinants of kick and drift"
    assert all(c["holds"] and c["residue"] == "0" for c in found["conditions"])
    status, out, _ = here(capsys, *EVERY, name)
    assert status == 0
    assert out.startswith(f"PROVED: det J ≡ 1, and order {order}")
    assert out.count(": holds") == len(orders)
    assert f"no further: of h^{order + 1}" in out


def test_what_is_not_made_by_roots_has_no_certificate_and_that_is_said(
    capsys: pytest.CaptureFixture[str], tmp_path
) -> None:
    file, own = tmp_path / "c.json", "kick pi; drift 1; kick 1 - pi"
    status, _, err = here(capsys, *EVERY, own, "--certificate", str(file))
    assert status == 2
    assert err == f"verify: --scheme={own}: pi is not made by roots: no certificate\n"
    assert not file.exists()
    for name in ("ruth3", "yoshida4", "kick sqrt(2); drift 1; kick 1 - sqrt(2)"):
        status, _, _ = here(capsys, *EVERY, name, "--certificate", str(file))
        assert status == 0
        status, out, _ = here(capsys, "certificate", "check", str(file))
        assert (status, out.split(":")[0]) == (0, "holds")
        assert ("= the root of " in out) is (name != "ruth3")
