"""The claims of a paper: their kinds, the file that holds them, and their verdicts."""
