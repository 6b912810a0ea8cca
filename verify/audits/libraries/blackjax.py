"""blackjax's integrators of trajectories, which its documentation calls symplectic; of their orders
it says nothing."""

from collections.abc import Iterator

from verify.audits.methods.driver import HENON_HEILES, TWO_WAVES, Driver, drive_problems
from verify.audits.methods.integrator import ReleasedIntegrator

TITLE = "blackjax"
LIBRARY = "blackjax"
EXTRA = "heavy-peers"
LEFT_OUT = (
    ("isokinetic_…", "preserve the length of p: no flow of H = T(p) + V(q)"),
    ("implicit_midpoint", "solves its equations to a tolerance of its own"),
)
_STEP = Driver(
    """\
import jax
import jax.numpy as jnp
import numpy as np
from blackjax.mcmc import integrators

jax.config.update("jax_enable_x64", True)


@jax.custom_jvp
def log_density(q):
    return jnp.float64(0)


@log_density.defjvp
def _(q, dq):
    f = jax.pure_callback(lambda x: np.asarray(force(0.0, np.asarray(x))), q[0], q[0])
    return jnp.float64(0), jnp.dot(f, dq[0])


step_of = jax.jit(integrators.{method}(log_density, lambda p, **_: jnp.sum(p**2) / 2))
""",
    """\
q, p = jnp.atleast_1d(jnp.asarray(q, float)), jnp.atleast_1d(jnp.asarray(p, float))
state = integrators.IntegratorState(q, p, 0.0, jnp.asarray(force(t, np.asarray(q))))
state = step_of(state, h)
q, p = np.asarray(state.position), np.asarray(state.momentum)
""",
    "one call of the integrator with the step h, the kinetic energy p²/2",
)


def integrators() -> Iterator[ReleasedIntegrator]:
    claim = "the documentation of blackjax.mcmc.integrators: “Symplectic, time-reversible”"
    for method in ("velocity_verlet", "mclachlan", "yoshida", "omelyan"):
        problems = TWO_WAVES, HENON_HEILES
        yield from drive_problems(method, _STEP, method, claim, None, True, problems)
