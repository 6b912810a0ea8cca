"""Step map → program → loop → N steps; and the rounding of a step, counted."""
