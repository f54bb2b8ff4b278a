#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ina219 0.2.1 (Rust): a motor that takes 83.2 W from 26 V has a power of -47.9 W, and simulate() makes 5.6 A of -1 A.
#
# By the data sheet the power register of an INA219 has 16 bits without a sign, unlike the one of the current; its unit
# is 20 units of the current, here 2 mW. Expected of next_measurement() at 3.2 A and 26 V, where the register is 41600:
# 83.2 W. What happens: -47.872 W, as the register is taken with a sign; up to 65.5 W it is right. simulate(), which is
# to calculate as the chip does, also limits the power to 65535, but gives -47.872 W for the same state. Expected of it
# for a motor that feeds -1 A back: -1 A. What happens: 5.5536 A in units of 200 uA at 12 V, and the error MathOverflow
# in units of 100 uA at 26 V, as the voltage of the shunt is taken without its sign. A table of registers answers here
# as the chip does.
# For us: multiply the current with the voltage of the bus yourself, or a motor seems to brake where it is driven most.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "power"
version = "0.1.0"
edition = "2021"
[dependencies]
embedded-hal = "=1.0.0"
ina219 = { version = "=0.2.1", default-features = false, features = ["sync"] }
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use ina219::address::Address;
use ina219::calibration::{simulate, IntCalibration, MicroAmpere};
use ina219::measurements::{BusVoltage, ShuntVoltage};
use ina219::SyncIna219;
use std::convert::Infallible;

/// The registers of a chip whose shunt of 0.1 Ohm is passed by a current in mA from a bus with a voltage in mV.
struct Chip {
    current: i32,
    voltage: u16,
    calibration: u16,
    pointer: u8,
}

impl Chip {
    fn register(&self) -> u16 {
        // The shunt in units of 10 uV, and what the data sheet calculates from it.
        let shunt = self.current * 10;
        let current = shunt * i32::from(self.calibration) / 4096;
        match self.pointer {
            0 => 0x399F,
            1 => shunt as u16,
            2 => (self.voltage / 4) << 3 | 0b10,
            3 => (current.abs() * i32::from(self.voltage / 4) / 5000) as u16,
            4 => current as u16,
            _ => self.calibration,
        }
    }
}

impl ErrorType for Chip {
    type Error = Infallible;
}

impl I2c for Chip {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
        for operation in operations {
            match operation {
                Operation::Write(bytes) => {
                    self.pointer = bytes[0];
                    if let [5, high, low] = bytes {
                        self.calibration = u16::from_be_bytes([*high, *low]);
                    }
                }
                Operation::Read(bytes) => bytes.copy_from_slice(&self.register().to_be_bytes()),
            }
        }
        Ok(())
    }
}

fn main() {
    // A current in units of 100 uA, a power in units of 2 mW.
    let fine = IntCalibration::new(MicroAmpere(100), 100_000).unwrap();
    for (current, expected) in [(1000, 26_000_000), (2500, 65_000_000), (3200, -47_872_000)] {
        let chip = Chip { current, voltage: 26_000, calibration: 0, pointer: 0 };
        let mut sensor = SyncIna219::new_calibrated(chip, Address::from_byte(0x40).unwrap(), fine).unwrap();
        let found = sensor.next_measurement().unwrap().unwrap();
        println!("{current} mA at 26 V: {} and {}", found.current, found.power);
        assert_eq!((found.current.0, found.power.0), (1000 * i64::from(current), expected));
    }
    let found = simulate(&fine, BusVoltage::from_mv(26_000), ShuntVoltage::from_10uv(32_000)).unwrap();
    println!("3200 mA at 26 V, simulated: {} and {}", found.current, found.power);
    assert_eq!((found.current.0, found.power.0), (3_200_000, -47_872_000));

    let back = |calibration| simulate(&calibration, BusVoltage::from_mv(12_000), ShuntVoltage::from_10uv(-10_000));
    let coarse = back(IntCalibration::new(MicroAmpere(200), 100_000).unwrap()).unwrap();
    println!("-1000 mA, simulated in units of 200 uA: {}", coarse.current);
    assert_eq!(coarse.current.0, 5_553_600);
    let twice = simulate(&fine, BusVoltage::from_mv(26_000), ShuntVoltage::from_10uv(-10_000));
    println!("-1000 mA at 26 V, simulated in units of 100 uA: {twice:?}");
    assert!(twice.is_err());
}
RUST
timeout 280 cargo run --quiet
