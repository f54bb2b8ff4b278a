# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Exact kinematics of an anti-backlash planetary servo actuator, beside its motor driver."""
