"""Messages about a text that is no formula: the likely mistake, its place, and what to write.

Nothing here decides what a formula is: the parser has refused the text already. So a rule that
guesses badly makes a bad message, and refuses nothing.
"""
