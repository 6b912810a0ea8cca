"""Results for the plane alone: telescoping in general, the growth law of Λ, modified fields.

A G with X·G equal to the leading coefficient of ΔJ is sought among polynomials in the coefficient's
own functions; in n degrees of freedom only lieη is shown to telescope, by a formula
(`proof.telescoping`).
"""
