"""The proof of a scheme: its map, its Jacobian matrix, ΔJ and both orders."""

from verify.pages.sections.section import ReportSection

SECTION = ReportSection(order=10, view=lambda _, proof, __: None if proof.form else proof)
