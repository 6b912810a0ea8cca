"""What Rocq says of the theory and of exported certificates."""
