#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# motor-driver-hal 0.1.3 (Rust): a motor that has not moved has reached its target of ten turns.
#
# check_ppr() "validates that the motor has reached the desired position based on encoder feedback and configured pulses
# per revolution". An encoder has 1000 pulses a turn. Expected for a target of 10 000 pulses: an error until the motor
# is there. What happens: Ok(()) at 0, as the position and the target are compared as remainders of 1000, and so at each
# whole thousand. As each edge counts, four to a pulse, these are not even whole turns: after a quarter turn, which has
# 1000 edges, it is Ok(()) too. The example of its description, a target of 1000, is reached before any motion as well.
# Output: target 10000: at 0 Ok(()), at 1 Err(HardwareFault), at 1000 Ok(()), at 9999 Err(HardwareFault),
#           at 10000 Ok(())
# For us: compare get_pulse_count(), which counts edges, with the target yourself.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "position"
version = "0.1.0"
edition = "2021"
[dependencies]
motor-driver-hal = "=0.1.3"
embedded-hal = "=1.0.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use embedded_hal::pwm::{ErrorType as PwmErrorType, SetDutyCycle};
use motor_driver_hal::{driver::HBridgeMotorDriver, MotorDriver};
use std::{cell::Cell, convert::Infallible, rc::Rc};

/// An output pin, a channel of the encoder or a PWM: its value is shared with the test.
#[derive(Clone, Default)]
struct Line(Rc<Cell<u16>>);

impl ErrorType for Line {
    type Error = Infallible;
}

impl OutputPin for Line {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.set(0);
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(1);
        Ok(())
    }
}

impl InputPin for Line {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get() > 0)
    }
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get() == 0)
    }
}

impl PwmErrorType for Line {
    type Error = Infallible;
}

impl SetDutyCycle for Line {
    fn max_duty_cycle(&self) -> u16 {
        1000
    }
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.set(duty);
        Ok(())
    }
}

fn main() {
    let line = Line::default;
    let (a, b) = (line(), line());
    let mut motor =
        HBridgeMotorDriver::dual_pwm_with_encoder(line(), line(), line(), line(), a.clone(), b.clone(), 1000);
    motor.initialize().unwrap();
    motor.set_ppr(1000).unwrap();
    motor.set_target_pulse(10_000);
    let mut text = String::from("target 10000:");
    for edge in 0..=10_000 {
        let (level_a, level_b) = [(0, 0), (1, 0), (1, 1), (0, 1)][edge % 4];
        a.0.set(level_a);
        b.0.set(level_b);
        let reached = motor.check_ppr();
        assert_eq!(motor.get_pulse_count(), edge as i32);
        assert_eq!(reached.is_ok(), edge % 1000 == 0);
        if [0, 1, 1000, 9999, 10_000].contains(&edge) {
            text += &format!("{} at {edge} {reached:?}", if edge == 0 { "" } else { "," });
        }
    }
    println!("{text}");
}
RUST
timeout 170 cargo run --quiet
