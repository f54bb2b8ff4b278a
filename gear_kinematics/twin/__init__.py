# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The actuator without hardware: what it is made of, and two models that move it."""
