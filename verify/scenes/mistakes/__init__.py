"""The likely mistake in a scene's file that is refused, and what to write instead."""
