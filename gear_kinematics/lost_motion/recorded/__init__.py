"""Recordings of a gear, as CSV files or bags: what they contain and when they were made."""
