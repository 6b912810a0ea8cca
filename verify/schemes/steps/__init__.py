"""The operations of a step, read as power series in h; two-forms, and S of a series."""
