#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pydvma 2.8.1: in two frames of a record of 20 000 samples the last third is not looked at, and two vibrations that
# have nothing to do with each other have a coherence of 1.
#
# calculate_cross_spectrum_matrix() and calculate_tf() are documented to give "exactly" N_frames segments at their
# default overlap. Expected of two independent noises with N_frames=2: a mean coherence near 0.5. What happens: 0.51
# with 19 998 samples, but exactly 1 at all frequencies with 20 000 or 50 000. The length of a segment is rounded up, so
# that the second one no longer fits into the record, and is left out without a warning; of a single segment the
# coherence is always 1. So a third of the record is lost: a vibration that begins there has a spectrum of 0.
# For us: cut a record to a multiple of 2 (N_frames + 1) samples, or give many frames.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pydvma==2.8.1 scipy==1.17.1 numpy==2.4.6
cd "$folder"
MPLBACKEND=Agg OMP_NUM_THREADS=1 timeout 120 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
from pydvma.analysis import calculate_cross_spectrum_matrix, calculate_tf
from pydvma.datastructure import TimeData
from pydvma.options import MySettings

RATE = 10_000.0


def record(*channels):
    settings = MySettings(fs=RATE, channels=len(channels), stored_time=len(channels[0]) / RATE)
    return TimeData(np.arange(len(channels[0])) / RATE, np.column_stack(channels), settings)


def coherences(length, frames):
    """The mean coherence of two independent noises, by both functions."""
    torque, vibration = np.random.default_rng(1).normal(size=(2, length))
    both = record(torque, vibration)
    spectra = calculate_cross_spectrum_matrix(both, window='hann', N_frames=frames)
    transfer = calculate_tf(both, window='hann', N_frames=frames)
    return round(float(spectra.Cxy[0, 1, 1:].mean()), 2), round(float(np.mean(transfer.tf_coherence[1:])), 2)


def late_vibration(length):
    """The greatest power of a vibration of 1 g at 100 Hz that begins at 0.7 of the record."""
    late = np.sin(2 * np.pi * 100 * np.arange(length) / RATE) * (np.arange(length) >= 0.7 * length)
    return float(np.real(calculate_cross_spectrum_matrix(record(late, late), N_frames=2).Pxy[0, 0]).max())


found = {length: (coherences(length, 2), late_vibration(length)) for length in (19_998, 20_000, 50_000)}
print('coherence and late vibration in two frames', found)
for length, (coherence, power) in found.items():
    if length == 19_998:
        assert all(0.4 < value < 0.65 for value in coherence) and power > 0.01
    else:
        assert coherence == (1.0, 1.0) and power == 0.0
PYTHON
