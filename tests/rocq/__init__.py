"""What Rocq's `coqc` says of the theory and of exported certificates."""
