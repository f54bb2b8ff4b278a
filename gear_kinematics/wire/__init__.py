"""Messages as bytes: CDR to numbers and back, one message at a time or in batches."""
