"""Torque ramps: hysteresis, and the models of spring, play, friction and time behind it."""
