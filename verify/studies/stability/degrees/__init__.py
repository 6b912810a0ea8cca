"""Runs in n degrees of freedom, judged: chaos, and other sensitive motion, told apart."""
