#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# falcon_mdf 0.7.2 (Rust): the difference of two encoders is valid where one of them is not, and counts are not
# interpolated.
#
# Its series have a flag per sample, true for valid. Expected of the difference of an output and a rotor whose second
# sample is invalid: the second sample is invalid. What happens: the flags of both are combined by "or", so that a
# sample is valid if either is; if only one of both has flags, its flags are kept, and the difference is right. Expected
# of resample() with InterpolationMode::Linear at a quarter of the time from 100 to 200 counts: 125, as documented for
# numeric channels. What happens: whole numbers hold their last value, 100, without an error; the same numbers as F64
# give 125. The power of a torque and a speed has the unit N·m instead of W.
# For us: combine the flags by "and" yourself, and convert counts to angles before resampling.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "invalid"
version = "0.1.0"
edition = "2021"
[dependencies]
falcon_mdf = "=0.7.2"
TOML
cat > src/main.rs <<'RUST'
use falcon_mdf::{InterpolationMode, SignalSeries, SignalValues};

fn series(name: &str, unit: &str, values: SignalValues, validity: Option<Vec<bool>>) -> SignalSeries {
    let times = (0..values.len()).map(|sample| sample as f64).collect();
    SignalSeries::from_samples(name, unit, times, values, validity).unwrap()
}

fn main() {
    let rotor = SignalValues::F64(vec![0.0, 999.0, 40.0, 60.0]);
    let rotor = series("rotor", "rad", rotor, Some(vec![true, false, true, true])).mul_scalar(0.05).unwrap();
    let values = SignalValues::F64(vec![0.0, 1.0, 2.0, 3.0]);
    let output = series("output", "rad", values.clone(), Some(vec![true; 4]));
    let error = output.sub(&rotor).unwrap();
    println!("error {:?}, valid {:?}", error.values_f64(), error.validity());
    assert_eq!(error.validity(), Some(&[true; 4][..]));
    let unflagged = series("output", "rad", values, None).sub(&rotor).unwrap();
    println!("of an output without flags: valid {:?}", unflagged.validity());
    assert_eq!(unflagged.validity(), Some(&[true, false, true, true][..]));

    let quarter = |values| series("counts", "", values, None).resample(vec![0.25], InterpolationMode::Linear).unwrap();
    let (whole, real) = (quarter(SignalValues::I32(vec![100, 200])), quarter(SignalValues::F64(vec![100.0, 200.0])));
    println!("at a quarter: {:?}, {:?}", whole.values(), real.values());
    assert_eq!((whole.values_f64(), real.values_f64()), (vec![100.0], vec![125.0]));

    let torque = series("torque", "N·m", SignalValues::F64(vec![3.0]), None);
    let power = torque.mul(&series("speed", "rad/s", SignalValues::F64(vec![2.0]), None)).unwrap();
    println!("{:?} {}", power.values_f64(), power.unit());
    assert_eq!(power.unit(), "N·m");
}
RUST
timeout 280 cargo run --quiet
