"""One document for every report, and its renderings. Knows no other room."""
