#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dynamixel 0.1.1 (Rust): a goal of 1.9 mrad is sent to a PRO servo as 0, and an MX-28 that is sent its own position
# creeps away.
#
# An M42-10-S260-R has 263187 counts per turn. Expected of a goal of 1.9 mrad: 80 counts. What happens: the goal is
# first cut off to whole steps of 2 mrad, so that 0 is sent, and 131509 for a goal of π, 2 mrad short of the 131593
# counts of half a turn. An MX-28 has 4096 counts per turn, 651.90 per rad. Expected: its goals and positions are scaled
# by that. What happens: goals by 651.09 and positions by 652.23, and the goal is cut off towards the centre. A servo at
# 3000 counts that is sent its own position gets 2998, then 2996, and it is at 2800 counts after 100 times: 17.6° away.
# The interface here is a servo that answers from its memory.
# For us: to hold a servo, send a goal that was set once, not the position that was read; take counts for what has to be
# exact.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "goal"
version = "0.1.0"
edition = "2021"
[dependencies]
dynamixel = { version = "=0.1.1", default-features = false }
TOML
cat > src/main.rs <<'RUST'
use dynamixel::{dynamixel::mx28::MX28, pro::M4210S260R, protocol1, protocol2, BaudRate, CommunicationError, Interface, Servo};

/// A servo on the bus that keeps what is written to it, and stands where it was sent.
struct Bus {
    second: bool,
    goal: i32,
    sent: Vec<u8>,
    answer: Vec<u8>,
}

fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc: u16, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| if crc >> 15 == 1 { crc << 1 ^ 0x8005 } else { crc << 1 })
    })
}

impl Bus {
    fn answer(&mut self) {
        let sent = std::mem::take(&mut self.sent);
        if self.second {
            self.goal = i32::from_le_bytes(sent[10..14].try_into().unwrap());
            self.answer = vec![0xff, 0xff, 0xfd, 0, sent[4], 4, 0, 0x55, 0];
            self.answer.extend(crc16(&self.answer).to_le_bytes());
        } else if sent[4] == 2 {
            let goal = self.goal.to_le_bytes();
            self.answer = vec![0xff, 0xff, sent[2], 4, 0, goal[0], goal[1]];
            self.answer.push(!self.answer[2..].iter().fold(0, |sum: u8, byte| sum.wrapping_add(*byte)));
        } else {
            self.goal = i32::from(u16::from_le_bytes([sent[6], sent[7]]));
            self.answer = vec![0xff, 0xff, sent[2], 2, 0, !(sent[2] + 2)];
        }
    }
}

impl Interface for Bus {
    fn set_baud_rate(&mut self, _: BaudRate) -> Result<(), CommunicationError> {
        Ok(())
    }
    fn flush(&mut self) {}
    fn write(&mut self, data: &[u8]) -> Result<(), CommunicationError> {
        self.sent.extend(data);
        Ok(())
    }
    fn read(&mut self, data: &mut [u8]) -> Result<(), CommunicationError> {
        if !self.sent.is_empty() {
            self.answer();
        }
        data.copy_from_slice(&self.answer.drain(..data.len()).collect::<Vec<u8>>());
        Ok(())
    }
}

fn main() {
    let mut bus = Bus { second: true, goal: -1, sent: vec![], answer: vec![] };
    let mut pro = M4210S260R::new(protocol2::ServoID::new(1), BaudRate::Baud57600);
    let mut sent = |goal: f32| {
        pro.set_position(&mut bus, goal).unwrap();
        println!("goal {goal} rad: {} counts, right are {:.0}", bus.goal, f64::from(goal) * 131593.5 / std::f64::consts::PI);
        bus.goal
    };
    assert_eq!([sent(0.0019), sent(0.0021), sent(std::f32::consts::PI)], [0, 83, 131509]);

    let mut bus = Bus { second: false, goal: 3000, sent: vec![], answer: vec![] };
    let mut mx28 = MX28::new(protocol1::ServoID::new(1), BaudRate::Baud57600);
    let mut held = vec![bus.goal];
    for _ in 0..100 {
        let position = mx28.get_position(&mut bus).unwrap();
        mx28.set_position(&mut bus, position).unwrap();
        held.push(bus.goal);
    }
    println!("MX-28 that is sent its own position: {:?} ... {}", &held[..4], held[100]);
    assert_eq!((&held[..3], held[100]), (&[3000, 2998, 2996][..], 2800));
}
RUST
timeout 280 cargo run --quiet
