# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Estimates with their uncertainties, and linear fits to blocks of samples."""
