"""One document for every report, and its renderings."""
