"""A report as GitHub flavoured Markdown, with its figures beside it."""
