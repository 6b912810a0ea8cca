"""Campaigns of many thousand cases, run by a person; the suite takes a sample of each."""
