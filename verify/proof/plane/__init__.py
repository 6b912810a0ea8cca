"""Results for the plane alone: telescoping in general, the growth law of Λ, modified fields.

A G with X·G equal to the leading coefficient of ΔJ is searched among polynomials in the functions
of the coefficient. In n degrees of freedom only lieη is shown to telescope, by a formula
(`verify.proof.telescoping`).
"""
