"""Exact kinematics of an anti-backlash planetary servo actuator, beside its motor driver."""
