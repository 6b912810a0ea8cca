"""One question a folder: separation, stability, regions, error against run time, growth, proofs."""
