#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# oxictl 0.1.1 (Rust): the status word of a fault is that of no state of CiA 402, and that of a quick stop is that of
# another state.
#
# Ds402StateMachine stands in for a drive. Expected of its status words: those that CiA 402 has for its states, by which
# a master tells them, such as xxxx xxxx x0xx 1000 for a fault. What happens: five states are right. A fault is 0x0048,
# whose bits 3 and 6 are never set together, so that a master finds no state; a fault reaction is 0x0018, which is a
# fault; and a quick stop is 0x0010, which is not ready to switch on. Expected of the bit for a fault reset: it acts
# where it rises. What happens: it acts as long as it is set, so that a master that has left it set loses each later
# fault within two cycles.
# For us: test a driver's faults with another drive or by the bits of the state itself.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "ds402"
version = "0.1.0"
edition = "2021"
[dependencies]
oxictl = { version = "=0.1.1", features = ["protocol"] }
TOML
cat > src/main.rs <<'RUST'
use oxictl::protocol::canopen::{DriveState, Ds402StateMachine};

/// The state that a status word means by CiA 402.
fn meant(status: u16) -> Option<DriveState> {
    [
        (0x4f, 0x00, DriveState::NotReadyToSwitchOn),
        (0x4f, 0x40, DriveState::SwitchOnDisabled),
        (0x6f, 0x21, DriveState::ReadyToSwitchOn),
        (0x6f, 0x23, DriveState::SwitchedOn),
        (0x6f, 0x27, DriveState::OperationEnabled),
        (0x6f, 0x07, DriveState::QuickStopActive),
        (0x4f, 0x0f, DriveState::FaultReactionActive),
        (0x4f, 0x08, DriveState::Fault),
    ]
    .into_iter()
    .find(|(mask, value, _)| status & mask == *value)
    .map(|(_, _, state)| state)
}

fn main() {
    use DriveState::*;
    for state in [NotReadyToSwitchOn, SwitchOnDisabled, ReadyToSwitchOn, SwitchedOn, OperationEnabled] {
        assert_eq!(meant(state.status_word()), Some(state));
    }
    let mut drive = Ds402StateMachine::new();
    for control in [0x06, 0x07, 0x0f, 0x0b] {
        drive.apply_control_word(control);
    }
    println!("{:?}: {:#06x} means {:?}", drive.state, drive.status_word(), meant(drive.status_word()));
    assert_eq!((drive.state, meant(drive.status_word())), (QuickStopActive, Some(NotReadyToSwitchOn)));
    drive.inject_fault(0x7305);
    println!("{:?}: {:#06x} means {:?}", drive.state, drive.status_word(), meant(drive.status_word()));
    assert_eq!(meant(drive.status_word()), Some(Fault));
    drive.apply_control_word(0x0f);
    println!("{:?}: {:#06x} means {:?}", drive.state, drive.status_word(), meant(drive.status_word()));
    assert_eq!((drive.state, meant(drive.status_word())), (Fault, None));

    drive.apply_control_word(0x80);
    drive.inject_fault(0x7305);
    drive.apply_control_word(0x80);
    drive.apply_control_word(0x80);
    println!("after a second fault with the reset still set: {:?}", drive.state);
    assert_eq!(drive.state, SwitchOnDisabled);
}
RUST
timeout 280 cargo run --quiet
