"""The functions that users call from Python; a system and a scheme may have any of their forms."""
