"""The printer by which sympy writes an expression as the text of a formula."""

import sympy
from sympy.printing.str import StrPrinter


class FormulaPrinter(StrPrinter):  # type: ignore[misc]
    """sympy's text form, but for e (a parameter named E?) and for powers that are exponentials."""

    def _print_Exp1(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
        return "exp(1)"

    def _print_Pow(self, expr: sympy.Expr, rational: bool = False) -> str:  # noqa: N802
        if expr.exp.is_Rational:
            return str(super()._print_Pow(expr, rational))
        return f"exp({self._print(expr.exp * sympy.log(expr.base))})"
