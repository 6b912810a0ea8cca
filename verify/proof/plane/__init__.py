"""What is known in the plane alone: telescoping in general, the growth law of Λ, modified fields.

A leading coefficient of ΔJ is looked for as X·G among the functions that it is made of; in n
degrees of freedom that of lieη alone is known to telescope, by its formula (`proof.telescoping`).
"""
