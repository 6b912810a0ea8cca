"""The number systems, one file each."""
