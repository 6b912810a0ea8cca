"""An erratum to copy, for the authors and the editor of a paper, made from its report."""
