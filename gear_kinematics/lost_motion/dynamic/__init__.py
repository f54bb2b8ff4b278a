"""Rotor and output in motion: transmission error, lost motion on reversals, gear ratio."""
