"""Drawn H(p, q, t) with every property of `tests.property.schemes.test_drawn_in_time`.

    python -m tests.campaigns.drawn_in_time --count 1000 --seed 1

So many are drawn for each property and, where it is of several schemes, each scheme. A failure ends
it with the shrunk example; else the counts and the time are told.
"""

import argparse
import time
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from tests.property.schemes import test_drawn_in_time as drawn

Test = Callable[..., None]
STEPS: list[tuple[Test, dict[str, Any], tuple[str, ...]]] = [
    (drawn.test_a_step_is_that_of_the_extended_autonomous_system,
     {"made": drawn.separable, "t0": drawn.moments}, tuple(drawn.BY_HAND)),
    (drawn.test_h_and_t0_may_be_shifted_together,
     {"made": drawn.in_time, "t0": drawn.moments, "shift": drawn.moments}, ("lie2", "rk4")),
    (drawn.test_a_periodic_h_has_a_periodic_map, {"made": drawn.separable}, ()),
    (drawn.test_lie2_is_of_order_3_with_the_divergence_as_its_coefficient,
     {"made": drawn.in_time}, ()),
    (drawn.test_splittings_and_the_midpoint_rule_preserve_area, {"made": drawn.separable}, ()),
    (drawn.test_what_is_drawn_has_t_and_reads_back, {"made": drawn.in_time}, ()),
]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    many = settings(max_examples=asked.count, deadline=None, database=None,
                    suppress_health_check=list(HealthCheck))  # fmt: skip
    for test, strategies, schemes in STEPS:
        inner: Test = test.hypothesis.inner_test  # type: ignore[attr-defined]
        own = {"scheme": st.sampled_from(schemes)} if schemes else {}
        begun = time.perf_counter()
        seed(asked.seed)(many(given(**strategies, **own)(inner)))()
        print(f"{asked.count} of {test.__name__}: {time.perf_counter() - begun:.0f} s", flush=True)


if __name__ == "__main__":
    main()
