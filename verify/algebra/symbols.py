"""The symbols of the plane: p, q and the step size h."""

from verify.algebra.formula import symbol

P, Q, H_STEP = symbol("p"), symbol("q"), symbol("h")
