"""Identities that several arguments rest on, each with what spoils it."""
