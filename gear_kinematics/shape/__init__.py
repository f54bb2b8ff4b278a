# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Shapes of the bodies: teeth, outlines, URDF and the pin sheet; formatted angles."""
