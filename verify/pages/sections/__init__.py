"""What each section of a report shows: sentences, tables and pictures, all from the data."""
