"""What was found, as frozen data; numbers are exact decimal strings."""
