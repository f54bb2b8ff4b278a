# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What teeth, cam bearings and slots of a recorded gear carried, and whether its mesh held."""
