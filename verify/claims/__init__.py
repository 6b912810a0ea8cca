"""What a paper states: the kinds of claim, the file that holds them, and the judge."""
