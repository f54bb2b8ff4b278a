#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mpu6000 0.3.0 (Rust): an IMU at 36.5 °C is read at 365 °C, or by the acceleration of its x axis, and 20 Hz are 56 Hz.
#
# By the register map of the MPU-6000 (revision 4.2) TEMP_OUT stands at 0x41, the temperature is TEMP_OUT / 340 + 36.53
# °C, and the sample rate is 8 kHz / (1 + SMPLRT_DIV) without the low-pass, with a divider of eight bits. What happens:
# the temperature as f32 is 365.3 °C at TEMP_OUT = 0, while celcius() gives 36.53. read_temperature() reads the register
# of the acceleration, so that an arm that turns its x axis up, at 1 g, is read as 48 °C warmer. A sample rate of 20 Hz,
# which needs a divider of 399, is set by a divider of 143 without an error, and is 55.6 Hz.
# For us: use read_all() and celcius(), and no rates below 32 Hz without the low-pass.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder. The registers are of the script.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "temperature"
version = "0.1.0"
edition = "2021"
[dependencies]
mpu6000 = "=0.3.0"
TOML
cat > src/main.rs <<'RUST'
use mpu6000::bus::RegAccess;
use mpu6000::registers::Register;
use mpu6000::MPU6000;
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

const SMPLRT_DIV: usize = 0x19;
const ACCEL_XOUT_H: usize = 0x3B;
const TEMP_OUT_H: usize = 0x41;

struct Registers(Rc<RefCell<[u8; 128]>>);

impl RegAccess for Registers {
    type Error = Infallible;
    fn write(&mut self, register: Register, value: u8) -> Result<(), Infallible> {
        self.0.borrow_mut()[register as usize] = value;
        Ok(())
    }
    fn read(&mut self, register: Register) -> Result<u8, Infallible> {
        Ok(self.0.borrow()[register as usize])
    }
    fn reads(&mut self, register: Register, output: &mut [u8]) -> Result<(), Infallible> {
        let start = register as usize;
        output.copy_from_slice(&self.0.borrow()[start..start + output.len()]);
        Ok(())
    }
}

fn main() {
    let registers = Rc::new(RefCell::new([0u8; 128]));
    let set = |address: usize, value: i16| {
        registers.borrow_mut()[address..address + 2].copy_from_slice(&value.to_be_bytes());
    };
    let mut imu = MPU6000::new(Registers(registers.clone()));
    set(TEMP_OUT_H, 0);

    let (_, temperature, _) = imu.read_all().unwrap();
    let celsius: f32 = temperature.into();
    println!("at 36.53 °C: {celsius} °C as f32, {} hundredths by celcius()", temperature.celcius().0);
    assert!((celsius - 365.3).abs() < 0.01 && temperature.celcius().0 == 3653);

    let mut read = |acceleration: i16| {
        set(ACCEL_XOUT_H, acceleration);
        imu.read_temperature().unwrap().celcius().0
    };
    let (level, upright) = (read(0), read(16384)); // 0 and 1 g in the range of 2 g
    println!("read_temperature() at 0 and 1 g along x: {level} and {upright} hundredths of °C");
    assert!(level == 3653 && upright == 8471);

    imu.set_sample_rate(20).unwrap();
    let divider = registers.borrow()[SMPLRT_DIV];
    let rate = 8000.0 / (1.0 + divider as f64);
    println!("20 Hz without the low-pass: a divider of {divider}, which is {rate:.1} Hz");
    assert!(divider == 143 && (rate - 55.6).abs() < 0.1);
}
RUST
timeout 280 cargo run --quiet
