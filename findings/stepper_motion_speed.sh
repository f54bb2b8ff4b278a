#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# stepper-motion 0.1.1 (Rust): a turn takes 7.8 s instead of 1.5 s at 52 times its acceleration, and its backlash
# compensation does nothing.
#
# A stepper of 3200 steps a turn may turn at 360°/s and accelerate by 720°/s², which takes 1.5 s for a turn. What
# happens: the time between two steps falls evenly from step to step, not the speed, so that the motor is slow for
# long and then accelerates by 37 000°/s². A move by 9°, which is to reach 80°/s, goes up to 360°/s all the same, with
# 348 000°/s². A real motor loses its steps there. backlash_compensation_deg = 4.5 has no effect: a move back by 90°
# has 800 steps, not 840. A trajectory of the file with velocity_percent = 10 is executed as fast as with 100.
# For us: set its greatest speed to one at which the motor can start from rest, and add the backlash to the goal.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "speed"
version = "0.1.0"
edition = "2021"
[dependencies]
stepper-motion = "=0.1.1"
embedded-hal = "=1.0.0"
toml = "0.8"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::{delay::DelayNs, digital::ErrorType, digital::OutputPin};
use std::{cell::RefCell, convert::Infallible, rc::Rc};
use stepper_motion::{config::units::Degrees, motor::StepperMotorBuilder, trajectory::TrajectoryRegistry, SystemConfig};

const CONFIG: &str = r#"
[motors.joint]
name = "joint"
steps_per_revolution = 200
microsteps = 16
gear_ratio = 1.0
max_velocity_deg_per_sec = 360.0
max_acceleration_deg_per_sec2 = 720.0
backlash_compensation_deg = 4.5
[trajectories.slow]
motor = "joint"
target_degrees = 360.0
velocity_percent = 10
"#;

/// The time in ns, and the times of all steps.
#[derive(Clone, Default)]
struct Bench(Rc<RefCell<(u64, Vec<u64>)>>);
struct Direction;

impl ErrorType for Bench {
    type Error = Infallible;
}
impl OutputPin for Bench {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        let mut bench = self.0.borrow_mut();
        let time = bench.0;
        bench.1.push(time);
        Ok(())
    }
}
impl DelayNs for Bench {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().0 += u64::from(ns);
    }
}
impl ErrorType for Direction {
    type Error = Infallible;
}
impl OutputPin for Direction {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// The number of steps of the last of several moves, its duration in s, and its greatest speed and acceleration in °/s
/// and °/s².
fn measured(targets: &[f32], trajectory: Option<&str>) -> (usize, f64, f64, f64) {
    let config: SystemConfig = toml::from_str(CONFIG).unwrap();
    let bench = Bench::default();
    let mut motor = StepperMotorBuilder::new()
        .step_pin(bench.clone())
        .dir_pin(Direction)
        .delay(bench.clone())
        .from_motor_config(config.motor("joint").unwrap())
        .build()
        .unwrap_or_else(|_| panic!());
    for target in targets {
        bench.0.borrow_mut().1.clear();
        motor = motor.move_to_blocking(Degrees(*target)).unwrap_or_else(|_| panic!());
    }
    if let Some(name) = trajectory {
        motor = motor.execute(name, &TrajectoryRegistry::from_config(&config)).unwrap_or_else(|_| panic!());
    }
    let _ = motor;
    let times: Vec<f64> = bench.0.borrow().1.iter().map(|time| *time as f64 * 1e-9).collect();
    let step = 360.0 / 3200.0;
    let speeds: Vec<f64> = times.windows(2).map(|pair| step / (pair[1] - pair[0])).collect();
    let speed = speeds.iter().copied().fold(0.0, f64::max);
    let accelerations = (1..speeds.len()).map(|i| (speeds[i] - speeds[i - 1]) / (0.5 * (times[i + 1] - times[i - 1])));
    let found = (times.len(), times.last().unwrap() - times[0], speed, accelerations.fold(0.0, f64::max));
    println!("to {targets:?} {trajectory:?}: {} steps in {:.3} s, at most {:.0}°/s and {:.0}°/s²", found.0, found.1, found.2, found.3);
    found
}

fn main() {
    let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.01;
    let long = measured(&[360.0], None);
    assert!(long.0 == 3200 && near(long.1, 7.812) && near(long.2, 360.0) && near(long.3, 37_357.0));
    let short = measured(&[9.0], None);
    assert!(short.0 == 80 && near(short.2, 360.0) && near(short.3, 348_344.0));
    let back = measured(&[360.0, 270.0], None);
    assert!(back.0 == 800);
    let slow = measured(&[], Some("slow"));
    assert!(slow.0 == 3200 && near(slow.1, long.1) && near(slow.2, 360.0));
}
RUST
timeout 280 cargo run --quiet
