# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the parameters of the node in recordings of both encoders, each with its evidence."""
