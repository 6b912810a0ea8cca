"""Error against run time, of schemes, number systems and peers."""
