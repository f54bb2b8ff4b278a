#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rrtk 0.7.1 (Rust): a controller without a derivative term gives NaN whenever it is updated before its encoder has a
# new reading.
#
# Its getters return the latest reading with the time of that reading, so a control loop that is faster than the encoder
# gets some readings twice. Expected of PIDControllerStream with kd = 0: the same output again. What happens: the
# derivative of an unchanged reading is 0/0, and 0 times NaN is NaN. The next new reading gives a number again.
# MovingAverageStream copes with it, but weights each reading by the time before it: of 0 at 0 ms and 0.1 at 10 ms the
# average over the last 15 ms is 0.067, as if the shaft had been at 0.1 rad for 10 ms already.
# For us: update the controller only with new readings, and let nothing that is not finite through to a motor.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "repeated"
version = "0.1.0"
edition = "2021"
[dependencies]
rrtk = { version = "=0.7.1", features = ["alloc"] }
TOML
cat > src/main.rs <<'RUST'
use rrtk::streams::control::{MovingAverageStream, PIDControllerStream};
use rrtk::{Datum, Getter, NothingOrError, Output, PIDKValues, Time, Updatable};

/// An encoder with a new reading every 10 ms, which is asked twice for the second and the third.
struct Encoder(usize);
const READINGS: [(i64, f32); 6] = [(0, 0.0), (10, 0.1), (10, 0.1), (20, 0.2), (20, 0.2), (30, 0.3)];
impl Updatable<()> for Encoder {
    fn update(&mut self) -> NothingOrError<()> {
        self.0 += 1;
        Ok(())
    }
}
impl Getter<f32, ()> for Encoder {
    fn get(&self) -> Output<f32, ()> {
        let (time, angle) = READINGS[self.0 - 1];
        Ok(Some(Datum::new(Time::from_nanoseconds(time * 1_000_000), angle)))
    }
}

fn outputs(mut stream: impl Getter<f32, ()>) -> Vec<f32> {
    let next = |_| {
        stream.update().unwrap();
        stream.get().unwrap().unwrap().value
    };
    (0..READINGS.len()).map(next).collect()
}

fn main() {
    let controlled = outputs(PIDControllerStream::new(Encoder(0), 1.0, PIDKValues::new(10.0, 1.0, 0.0)));
    println!("controller: {controlled:?}");
    let lost: Vec<bool> = controlled.iter().map(|output| output.is_nan()).collect();
    assert_eq!(lost, [false, false, true, false, true, false]);
    let averages = outputs(MovingAverageStream::new(Encoder(0), Time::from_nanoseconds(15_000_000)));
    println!("average over 15 ms: {averages:?}");
    assert!((averages[1] - 0.0667).abs() < 0.0001);
}
RUST
timeout 280 cargo run --quiet
