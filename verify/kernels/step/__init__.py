"""The computation of one step: a step map → a straight-line program, and its lines of source."""
