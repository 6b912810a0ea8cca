"""The elementary functions, one file each with a `FUNCTION`, found by themselves."""
