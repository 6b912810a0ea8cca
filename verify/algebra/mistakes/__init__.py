"""What is likely wrong in a text that is no formula: where it stands, and what to write instead.

Nothing here decides what a formula is: the parser has refused the text, and asks why. So a rule
that guesses badly words an error badly, and refuses nothing.
"""
