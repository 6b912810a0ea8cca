"""Tables that are right, tables with one mistake, and what their steps are by series alone."""
