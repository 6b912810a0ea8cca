"""Text as a page sets it: numbers, formulas as MathML, words that all formats share."""
