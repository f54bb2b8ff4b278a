# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The deviation of the real output from the ideal one: measured, calibrated, corrected."""
