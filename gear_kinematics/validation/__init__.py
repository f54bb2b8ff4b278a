"""Compares the outputs of a node with recomputed ones."""
