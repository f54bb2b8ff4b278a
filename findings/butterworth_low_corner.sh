#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# butterworth 0.1.0 (Rust): a band-pass from 0.5 to 2 Hz at 1 kHz grows beyond 1e100, and a still shaft leaves its
# angle.
#
# The slow vibration of an arm, sampled at 1 kHz, and a shaft that stands at 100 rad, sampled at 10 kHz. Expected of a
# band-pass of order 4 from 0.5 to 2 Hz: an amplitude of 1 for a vibration of amplitude 1 at 1 Hz, as from 5 to 20 Hz
# for one at 10 Hz. What happens: it grows without end, as the filter is one polynomial of order 8, whose coefficients
# do not have enough digits for such a corner. Filter::new() gives no error. Expected of a low-pass of order 4 at 1 Hz
# for the still shaft, by bidirectional(): 100 rad. What happens: up to 0.4 rad away from it; at 1 kHz up to 0.06 mrad.
# For us: reduce the rate of the recording first, or filter with sections of order 2, as scipy.signal.sosfiltfilt().
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "corner"
version = "0.1.0"
edition = "2021"
[dependencies]
butterworth = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use butterworth::{Cutoff, Filter};

/// The greatest value, after 15 s at 1 kHz, of a vibration of amplitude 1 through a band-pass of order 4.
fn amplitude(from: f64, to: f64, frequency: f64) -> f64 {
    let filter = Filter::new(4, 1000.0, Cutoff::BandPass(from, to)).unwrap();
    let wave = |sample: usize| (2.0 * std::f64::consts::PI * frequency * sample as f64 / 1000.0).sin();
    let values = filter.forward(&(0..20_000).map(wave).collect());
    values[15_000..].iter().fold(0.0, |greatest, value| value.abs().max(greatest))
}

/// How far a low-pass of order 4 at 1 Hz takes a shaft that stands at 100 rad from there.
fn error(rate: f64) -> f64 {
    let filter = Filter::new(4, rate, Cutoff::LowPass(1.0)).unwrap();
    let values = filter.bidirectional(&vec![100.0; 3000]).unwrap();
    values.iter().fold(0.0, |greatest, value| (value - 100.0).abs().max(greatest))
}

fn main() {
    let (usual, slow) = (amplitude(5.0, 20.0, 10.0), amplitude(0.5, 2.0, 1.0));
    println!("amplitude of 10 Hz from 5 to 20 Hz: {usual}, of 1 Hz from 0.5 to 2 Hz: {slow:e}");
    assert!((usual - 1.0).abs() < 0.001 && slow > 1e50);
    let (at_1_khz, at_10_khz) = (error(1000.0), error(10_000.0));
    println!("a shaft at 100 rad is {at_1_khz:e} rad away at 1 kHz, {at_10_khz} rad at 10 kHz");
    assert!(at_1_khz > 1e-6 && at_1_khz < 1e-3 && at_10_khz > 0.01);
}
RUST
timeout 280 cargo run --quiet
