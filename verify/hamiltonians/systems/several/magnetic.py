"""A charged particle in a plane, across it a constant magnetic field: it is not T(p) + V(q).

The velocity is v = (p1 + b q2/2, p2 − b q1/2), and v1' = b v2 − V_q1, v2' = −b v1 − V_q2. Without
V it goes round with the cyclotron frequency b; in V = k|q|²/2 its two frequencies are
√(k + b²/4) ± b/2.
"""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="magnetic",
    title="charged particle in a magnetic field and a potential",
    formula=("((p1 + b*q2/2)**2 + (p2 - b*q1/2)**2)/2 + k*(q1**2 + q2**2)/2 + c*q1**2*q2**2/2"),
    source="L. D. Landau, E. M. Lifshitz, The Classical Theory of Fields, §16, in symmetric gauge",
    parameters={
        "b": "the cyclotron frequency: charge times field by mass",
        "k": "strength of the linear restoring force",
        "c": "strength of the cubic one, which couples q1 and q2",
    },
    regimes={
        "cyclotron": {"b": "2", "k": "0", "c": "0", "p": "1, 0", "q": "1/2, 1/3"},
        "trap": {"b": "3/2", "k": "1", "c": "0", "p": "1/4, 0", "q": "1/2, -1/3"},
        "coupled": {"b": "1", "k": "1", "c": "1", "p": "1/2, 0", "q": "0, 3/4"},
    },
)
