#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# accel-stepper 0.1.0 (Rust): at a constant speed a motor trembles on the spot, and a new goal behind it reverses it at
# full speed.
#
# It is a port of the Arduino library of this name. Expected after 1 s at a constant speed of 100 steps/s: 100 steps,
# and -100 at -100 steps/s. What happens: the direction of a step is not that of the speed, but that from the position
# to the goal, and forward needs a goal that is ahead. From a goal of 0 the motor steps back and forth between -1 and 0.
# Expected of a goal behind a motor that runs at 500 steps/s with an acceleration of 100 steps/s²: it runs on for 1250
# steps until it stands. What happens: its next step goes back, one period of 2 ms later, and its speed goes from 500 to
# -500 steps/s.
# For us: a motor loses its steps there, which looks like a slipped coupling. Give a goal far ahead for a constant
# speed, and a goal behind only at standstill.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "direction"
version = "0.1.0"
edition = "2021"
[dependencies]
accel-stepper = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use accel_stepper::{func_device, Driver, SystemClock};
use std::cell::Cell;
use std::time::Duration;

struct Clock(Cell<Duration>);
impl SystemClock for Clock {
    fn elapsed(&self) -> Duration {
        self.0.set(self.0.get() + Duration::from_micros(100));
        self.0.get()
    }
}

fn motor() -> (Driver, Clock) {
    let mut motor = Driver::new();
    motor.set_max_speed(500.0);
    motor.set_acceleration(100.0);
    (motor, Clock(Cell::new(Duration::ZERO)))
}

fn constant(speed: f32, goal: i64) -> (i64, i64, i64) {
    let (mut motor, clock) = motor();
    motor.move_to(goal);
    motor.set_speed(speed);
    let mut coils = func_device(|| (), || ());
    let (mut least, mut greatest) = (0, 0);
    for _ in 0..10_000 {
        motor.poll_at_constant_speed(&mut coils, &clock).unwrap();
        least = least.min(motor.current_position());
        greatest = greatest.max(motor.current_position());
    }
    (least, greatest, motor.current_position())
}

fn main() {
    for speed in [100.0, -100.0] {
        let (least, greatest, end) = constant(speed, 0);
        println!("{speed} steps/s: from {least} to {greatest}, after 1 s at {end}");
        assert!((least, greatest) == (-1, 0));
    }
    println!("100 steps/s with a goal far ahead: {}", constant(100.0, 1_000_000).2);
    assert!((99..=100).contains(&constant(100.0, 1_000_000).2));

    let (mut motor, clock) = motor();
    let mut coils = func_device(|| (), || ());
    motor.move_to(10_000);
    for _ in 0..100_000 {
        motor.poll(&mut coils, &clock).unwrap();
    }
    let (turned, speed) = (motor.current_position(), motor.speed());
    motor.move_to(0);
    let mut furthest = turned;
    for _ in 0..1000 {
        motor.poll(&mut coils, &clock).unwrap();
        furthest = furthest.max(motor.current_position());
    }
    let back = turned - motor.current_position();
    println!("at {speed} steps/s: {} steps further, then {back} steps back in 0.1 s", furthest - turned);
    assert!((speed - 500.0).abs() < 1.0 && furthest == turned && (49..=51).contains(&back));
}
RUST
timeout 280 cargo run --quiet
