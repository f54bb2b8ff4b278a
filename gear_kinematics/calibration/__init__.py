"""Calibrates the real output of a gear, from recordings of its rotor's and output's encoders.

The method and its sources are in docs/calibration.md.
"""
