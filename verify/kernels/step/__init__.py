"""What one step computes: a step map → a straight-line program, and its lines of source."""
