"""The data of requests and results: scenes, their sections and values, and models of results."""
