"""Several recordings: at one torque, before and after, over time, over positions."""
