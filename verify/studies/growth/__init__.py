"""The growth law of Λ: its predictions for an orbit, compared with runs."""
