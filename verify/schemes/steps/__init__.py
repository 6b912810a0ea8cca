"""What a step is made of, read as power series in h; two-forms, and S of such series."""
