"""Watches a running gear_state_publisher and the drivers beside it, on a page or in a terminal."""
