"""jax-md's step of velocity Verlet, and the weights of its thermostat chains."""

from collections.abc import Iterator

from verify.audits.methods.driver import HENON_HEILES, TWO_WAVES, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator, table_integrator

TITLE = "jax-md"
LIBRARY = "jax_md"
PACKAGE = "jax-md"
EXTRA = "heavy-peers"
LEFT_OUT = (
    ("nvt_…, npt_…, brownian", "are of other equations than H's, or of chance"),
    ("the weights of one step", "are 1"),
)
_STEP = Driver(
    """\
import jax
import jax.numpy as jnp
import numpy as np
from jax_md import simulate

jax.config.update("jax_enable_x64", True)
""",
    """\
q, p = np.atleast_1d(q)[None], np.atleast_1d(p)[None]
f = lambda x, **_: jnp.asarray(force(t, np.asarray(x)[0]))[None]
state = simulate.NVEState(jnp.asarray(q), jnp.asarray(p), f(q), jnp.float64(1))
state = simulate.velocity_verlet(f, lambda x, dx, **_: x + dx, h, state)
q, p = np.asarray(state.position), np.asarray(state.momentum)
""",
    "one call of simulate.velocity_verlet with the step h",
)
# The orders of Suzuki's and Yoshida's compositions, by their number of steps.
_ORDER_BY_STEPS = {3: 4, 5: 4, 7: 6}
_SOURCE = (
    "the documentation of simulate.nose_hoover_chain: “we follow the Suzuki-Yoshida scheme”, whose "
    "composition with {} steps is of order {}"
)


def integrators() -> Iterator[ReleasedIntegrator]:
    claim = "the documentation of simulate.nve: “a standard velocity Verlet integration scheme”"
    problems = TWO_WAVES, HENON_HEILES
    yield from drive_problems("velocity_verlet", _STEP, "velocity_verlet", claim, 2, True, problems)
    yield from _weights()


def _weights() -> Iterator[ReleasedIntegrator]:
    from jax_md import simulate

    for count, weights in simulate.SUZUKI_YOSHIDA_WEIGHTS.items():
        if count > 1:
            yield table_integrator(
                f"SUZUKI_YOSHIDA_WEIGHTS[{count}]",
                "composition",
                "the weights as they stand in simulate",
                _SOURCE.format(count, _ORDER_BY_STEPS[count]),
                _WEIGHTS_SCRIPT.replace("{count}", str(count)),
                order=_ORDER_BY_STEPS[count],
                of_parts=True,
                sizes=[repr(float(w)) for w in weights],
            )


_WEIGHTS_SCRIPT = """\
from jax_md.simulate import SUZUKI_YOSHIDA_WEIGHTS

w = SUZUKI_YOSHIDA_WEIGHTS[{count}]
print("sum of w, to be 1:", sum(w))
print("sum of w**3, 0 for order 4:", sum(x**3 for x in w))
"""
