"""Reference data: numbers whose every digit is known, for integrators to be tested against."""
