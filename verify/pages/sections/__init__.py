"""The sections of a report: sentences, tables and pictures, all from the data."""
