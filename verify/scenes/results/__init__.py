"""The results, as frozen data; numbers are exact decimal strings."""
