"""Mutation testing of the code under test: small planted errors, and the properties they break."""
