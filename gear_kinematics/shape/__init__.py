# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Shapes of the bodies: teeth, outlines, solids and the URDF; formatted angles."""
