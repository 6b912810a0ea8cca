"""What is checked: claims, steps, maps and tables of others, one command a file."""
