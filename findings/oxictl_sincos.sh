#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oxictl 0.1.1 (Rust): an ideal sine and cosine are read right for the first 0.11 rad, then up to 3.1 rad away.
#
# Its SincosEncoder corrects offsets and amplitudes "as the encoder rotates through a full cycle". Expected at ideal
# signals of amplitude 1 and no offset: their angle. What happens: as soon as a signal has covered 0.1, this part of a
# turn is taken as its whole range, and its middle as the offset; after that, each 0.1 again. The angle is right up to
# 0.11 rad, 0.75 rad away at 0.12 rad, and up to 3.07 rad away over the next turns. A shaft that turns at 10 rad/s is
# read at speeds from below -480 to above 480 rad/s.
# For us: take atan2(sine, cosine) yourself, with offsets and amplitudes that were measured over whole turns.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "sincos"
version = "0.1.0"
edition = "2021"
[dependencies]
oxictl = { version = "=0.1.1", features = ["motor"] }
TOML
cat > src/main.rs <<'RUST'
use oxictl::motor::encoder::sincos::SincosEncoder;
use std::f64::consts::TAU;

fn main() {
    let mut encoder = SincosEncoder::<f64>::new(1000.0);
    let mut read = Vec::new();
    for sample in 0..20_000 {
        let angle = 0.01 * f64::from(sample);
        encoder.update(angle.sin(), angle.cos(), 0.001);
        let difference = encoder.angle - angle;
        read.push((angle, difference - TAU * (difference / TAU).round(), encoder.velocity));
    }
    let worst = |part: &[(f64, f64, f64)]| part.iter().map(|sample| sample.1.abs()).fold(0.0, f64::max);
    for sample in [0, 5, 11, 12, 2000, 4000] {
        let (angle, difference, speed) = read[sample];
        println!("at {angle:.2} rad: {difference:.3} rad away, {speed:.0} rad/s");
    }
    println!("greatest difference up to 0.11 rad {:.1e} rad, beyond {:.2} rad", worst(&read[..12]), worst(&read[12..]));
    assert!(worst(&read[..12]) < 1e-9 && (read[12].1 - 0.752).abs() < 0.001 && worst(&read[12..]) > 3.0);
    assert!(read.iter().any(|sample| sample.2 > 480.0) && read.iter().any(|sample| sample.2 < -480.0));
}
RUST
timeout 280 cargo run --quiet
