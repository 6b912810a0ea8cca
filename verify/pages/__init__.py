"""Results → HTML and Markdown. Nothing is computed here."""
