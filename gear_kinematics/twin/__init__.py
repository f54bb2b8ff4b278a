# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The simulated actuator: its properties, and two models that move it."""
