"""Three bodies of mass 1 in a plane that attract each other with the force 1/r².

Body k is at (q1, q2), (q3, q4), (q5, q6), for k = 1, 2, 3. On the figure-eight, found by C. Moore,
all three follow one curve, with the period 6.32591398. On Euler's collinear orbit the third rests
between the others, which go round it with ω²r³ = 1 + 1/4; it is unstable.
"""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="three-body",
    title="planar three-body problem with equal masses",
    formula=(
        "(p1**2 + p2**2 + p3**2 + p4**2 + p5**2 + p6**2)/2"
        " - 1/sqrt((q1 - q3)**2 + (q2 - q4)**2)"
        " - 1/sqrt((q1 - q5)**2 + (q2 - q6)**2)"
        " - 1/sqrt((q3 - q5)**2 + (q4 - q6)**2)"
    ),
    source=(
        "A. Chenciner, R. Montgomery, Annals of Mathematics 152 (2000) 881–901; initial values of"
        " the figure-eight by C. Simó, there"
    ),
    regimes={
        "figure-eight": {
            "p": "0.466203685, 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146",
            "q": "0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0",
        },
        "collinear": {"p": "0, 1/2, 0, -1/2, 0, 0", "q": "5, 0, -5, 0, 0, 0"},
    },
)
