#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# biquad 0.6.0 (Rust): the band from 49 to 51 Hz has nearly the same filter as that from 25 to 100 Hz.
#
# `band_0db_from_cutting_frequencies()` makes a band-pass or a notch from the two edges of its band. Expected of both
# edges: 0.707 (-3 dB), and of 30 Hz with a notch from 49 to 51 Hz, which is to take the hum of the mains out of a
# measured torque: 0.999. What happens: only the middle of the band is taken from the edges, and the quality factor is
# 1 for each band, so that three bands around 50 Hz have nearly the same coefficients: a notch takes 27 % of a vibration
# at 30 Hz away, and a band-pass that is to find a gear mesh at 50 Hz passes 68 % of what is at 30 Hz. The function has
# no description. A band-pass of `from_params()` is not limited to 0 dB: its middle is multiplied by the quality factor,
# which is one of the two forms in the cookbook that the crate follows; which one, it does not say.
# Output: edges 49 and 51 Hz: band-pass 0.68 at 30 Hz, 1.00 at the lower edge; notch 0.73 and 0.04
#         edges 45 and 55 Hz: band-pass 0.68 at 30 Hz, 0.98 at the lower edge; notch 0.73 and 0.20
#         edges 25 and 100 Hz: band-pass 0.68 at 30 Hz, 0.55 at the lower edge; notch 0.73 and 0.83
#         notch of from_params(): 0.9990 at 30 Hz, 0.71 at 49 Hz
#         band-pass with a quality factor of 10: 10.00 at 50 Hz
# For us: call `from_params()` with the middle of the band and its quality factor, middle / (upper - lower edge), and
# divide a band-pass by this factor.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "band"
version = "0.1.0"
edition = "2021"
[dependencies]
biquad = "=0.6.0"
TOML
cat > src/main.rs <<'RUST'
use biquad::{Biquad, Coefficients, DirectForm2Transposed, ToHertz, Type};
use std::f64::consts::TAU;

const RATE: f64 = 1000.0;

/// The greatest output for a sine of amplitude 1, once the filter has settled.
fn gain(coefficients: &Coefficients<f64>, frequency: f64) -> f64 {
    let mut filter = DirectForm2Transposed::<f64>::new(*coefficients);
    (0..40_000)
        .map(|k| (k, filter.run((TAU * frequency * k as f64 / RATE).sin()).abs()))
        .filter(|(k, _)| *k > 30_000)
        .fold(0.0, |greatest, (_, output)| output.max(greatest))
}

fn made(kind: Type<f64>, lower: f64, upper: f64) -> Coefficients<f64> {
    Coefficients::band_0db_from_cutting_frequencies(kind, 2.0 * lower / RATE, 2.0 * upper / RATE).unwrap()
}

fn main() {
    for (lower, upper, at_edge, notch_at_edge) in
        [(49.0, 51.0, 0.999, 0.041), (45.0, 55.0, 0.980, 0.200), (25.0, 100.0, 0.550, 0.834)]
    {
        let (pass, notch) = (made(Type::BandPass, lower, upper), made(Type::Notch, lower, upper));
        println!(
            "edges {lower} and {upper} Hz: band-pass {:.2} at 30 Hz, {:.2} at the lower edge; \
             notch {:.2} and {:.2}",
            gain(&pass, 30.0), gain(&pass, lower), gain(&notch, 30.0), gain(&notch, lower)
        );
        assert!((gain(&pass, 30.0) - 0.68).abs() < 5e-3 && (gain(&notch, 30.0) - 0.73).abs() < 5e-3);
        assert!((gain(&pass, lower) - at_edge).abs() < 2e-3 && (gain(&notch, lower) - notch_at_edge).abs() < 2e-3);
    }
    let made_by = |quality| Coefficients::<f64>::from_params(Type::Notch, RATE.hz(), 49.99.hz(), quality).unwrap();
    let right = made_by(49.99 / 2.0);
    println!("notch of from_params(): {:.4} at 30 Hz, {:.2} at 49 Hz", gain(&right, 30.0), gain(&right, 49.0));
    assert!(gain(&right, 30.0) > 0.998 && (gain(&right, 49.0) - 0.707).abs() < 0.02);
    let pass = Coefficients::<f64>::from_params(Type::BandPass, RATE.hz(), 50.0.hz(), 10.0).unwrap();
    println!("band-pass with a quality factor of 10: {:.2} at 50 Hz", gain(&pass, 50.0));
    assert!((gain(&pass, 50.0) - 10.0).abs() < 1e-2);
}
RUST
timeout 170 cargo run --quiet
