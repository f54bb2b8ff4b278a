"""Several recordings: before and after, over positions of the output, over time."""
