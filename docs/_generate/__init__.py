"""What the manual takes from the code when it is built: parts of pages, toctrees, docstrings."""
