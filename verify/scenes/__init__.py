"""What is asked: scenes, their sections and values, and what results look like. Data alone."""
