#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# periph 1.3.1 (Rust): an AS5600 is refused where its magnet is right, and works only where the magnet is too strong.
#
# In the status of the encoder bit 5 says that there is a magnet, bit 4 that it is too weak, and bit 3 that it is too
# strong, as the datasheet and as5600 0.8.0 have it. What happens: bits 3 and 5 are exchanged. With a status of 0x20,
# the only good one, As5600Minimal::new() refuses the encoder because no magnet is detected. With 0x28, a magnet that is
# too strong, it works and says that the magnet is there and too strong; where this gets better later on,
# is_magnet_detected() is false and is_magnet_too_strong() true. burn_angle() is refused with a good magnet, too.
# For us: read the register 0x0B yourself, and take another driver.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "as5600"
version = "0.1.0"
edition = "2021"
[dependencies]
periph = "=1.3.1"
as5600 = "=0.8.0"
embedded-hal = "=1.0.0"
TOML
cat > src/main.rs <<'RUST'
use embedded_hal::i2c::{ErrorType, I2c, Operation};
use periph::chips::magnetometer::as5600::As5600Minimal;
use std::{cell::Cell, convert::Infallible, panic, rc::Rc};

/// An encoder at 90° whose status can be set.
#[derive(Clone)]
struct Encoder(Rc<Cell<u8>>);
impl ErrorType for Encoder {
    type Error = Infallible;
}
impl I2c for Encoder {
    fn transaction(&mut self, _: u8, operations: &mut [Operation<'_>]) -> Result<(), Infallible> {
        let mut register = 0;
        for operation in operations {
            match operation {
                Operation::Write(bytes) => register = bytes[0],
                Operation::Read(bytes) if register == 0x0b => bytes[0] = self.0.get(),
                Operation::Read(bytes) => bytes.copy_from_slice(&[0x04, 0x00][..bytes.len()]),
            }
        }
        Ok(())
    }
}

fn main() {
    let status = Rc::new(Cell::new(0x20));
    let bus = Encoder(status.clone());
    println!("as5600: {:?}", as5600::As5600::new(bus.clone()).magnet_status().unwrap());
    assert_eq!(as5600::As5600::new(bus.clone()).magnet_status().unwrap(), as5600::status::Status::MagnetDetected);

    panic::set_hook(Box::new(|_| {}));
    let refused = panic::catch_unwind(panic::AssertUnwindSafe(|| As5600Minimal::new(bus.clone(), 0x36))).err();
    let reason = refused.and_then(|reason| reason.downcast_ref::<&str>().map(|text| text.to_string()));
    println!("periph with a good magnet: {reason:?}");
    assert!(reason.unwrap().contains("magnet not detected"));

    status.set(0x28);
    let mut encoder = As5600Minimal::new(bus, 0x36).unwrap();
    println!("with a magnet that is too strong: {:?}, {}°", encoder.is_magnet_detected(), encoder.angle().unwrap());
    assert!(encoder.is_magnet_detected().unwrap() && encoder.angle().unwrap() == 90.0);
    status.set(0x20);
    println!("good again: detected {:?}, too strong {:?}", encoder.is_magnet_detected(), encoder.is_magnet_too_strong());
    assert!(!encoder.is_magnet_detected().unwrap() && encoder.is_magnet_too_strong().unwrap());
}
RUST
timeout 280 cargo run --quiet
