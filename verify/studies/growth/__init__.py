"""The growth law of Λ: what it predicts for an orbit, held against runs."""
