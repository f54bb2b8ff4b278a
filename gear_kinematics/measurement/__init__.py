# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Measurement of real gears: lost motion, stiffness, transmission error, calibration.

`reading.read` makes a `recording.Recording` of a file, and `lost_motion.measure` a `LostMotion` of
that. Definitions and their sources are in docs/lost_motion.md and docs/calibration.md.
"""
