"""Identities on which several arguments rest; a parameter of each spoils it, as a control."""
