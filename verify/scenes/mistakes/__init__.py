"""What is likely wrong in a scene's file that is refused, and what to write instead."""
