"""The deviation of the real output from the ideal one: measured, calibrated, corrected."""
