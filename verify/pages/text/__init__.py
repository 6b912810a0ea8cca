"""Typesetting of text on a page: numbers, formulas as MathML, words that all formats share."""
