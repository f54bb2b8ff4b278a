#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# odrive-rs 1.1.0 (Rust): the speed of a turning motor is 0, and a goal without limits sets both limits to 0.
#
# Expected: get_velocity() gives the speed of the axis, or an error. What happens: it asks for "axis0
# .encoder.vel_estimate", with a space, so that an ODrive is asked for "axis0" and answers in words; what cannot be read
# as a number is 0.0. set_position_q(axis, 3.0, None, None) sends "q 0 3 0 0", with which an ODrive limits speed and
# current of the axis to 0, and does not move. A stream answers here as firmware 0.5 does.
# For us: a speed of exactly 0.0 at a turning rotor is no measurement; differentiate the position.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
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
odrive-rs = "=1.1.0"
TOML
cat > src/main.rs <<'RUST'
use odrive_rs::prelude::*;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io::{Read, Result, Write};
use std::rc::Rc;

#[derive(Clone, Default)]
struct Drive {
    received: Rc<RefCell<Vec<String>>>,
    line: String,
    answers: VecDeque<u8>,
}

impl Write for Drive {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        for &byte in bytes {
            if byte != b'\n' {
                self.line.push(byte as char);
                continue;
            }
            let line = std::mem::take(&mut self.line);
            let mut words = line.split_whitespace();
            if words.next() == Some("r") {
                let answer = match words.next() {
                    Some("axis0.encoder.vel_estimate") => "12.5\n",
                    _ => "invalid property\n",
                };
                self.answers.extend(answer.bytes());
            }
            self.received.borrow_mut().push(line);
        }
        Ok(bytes.len())
    }
    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Read for Drive {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let count = into.len().min(self.answers.len());
        for (to, from) in into.iter_mut().zip(self.answers.drain(..count)) {
            *to = from;
        }
        Ok(count)
    }
}

fn main() {
    let drive = Drive::default();
    let mut odrive = ODrive::new(drive.clone());
    let speed = odrive.get_velocity(AxisID::Zero).unwrap();
    odrive.set_position_q(AxisID::Zero, 3.0, None, None).unwrap();
    writeln!(odrive, "r axis0.encoder.vel_estimate").unwrap();
    let right = odrive.read_float().unwrap();
    let received = drive.received.borrow();
    println!("speed {speed:?}, asked rightly {right:?}, sent {received:?}");
    assert_eq!((speed, right), (Some(0.0), Some(12.5)));
    assert_eq!(received[..2], ["r axis0 .encoder.vel_estimate", "q 0 3 0 0"]);
}
RUST
timeout 280 cargo run --quiet
