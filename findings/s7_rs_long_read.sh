#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# s7 0.1.9 (Rust): of 100 angles in a data block of an S7 PLC, those from the 57th on are read as 0, without error.
#
# An S7-1200 sends at most 240 bytes at a time, of which 222 are data, so that ag_read() asks for 400 bytes in two
# parts. Expected: 100 angles as REAL. What happens: the second part is asked for and answered, but not copied to the
# caller's buffer, which keeps what was in it; the 56th angle lies in both. The writing of 400 bytes is right.
# mb_read(), which shall read the flags (merkers) of the PLC, asks for a data block 0 instead, as eb_read() and
# ab_read() of inputs and outputs do, whereas mb_write() writes to the flags. A transport with a memory takes the
# place of the PLC. For us: read at most 222 bytes at a time from an S7-1200.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "read"
version = "0.1.0"
edition = "2021"
[dependencies]
s7 = "=0.1.9"
TOML
cat > src/main.rs <<'RUST'
use s7::client::Client;
use s7::error::Error;
use s7::transport::{Connection, Transport};
use std::cell::RefCell;
use std::rc::Rc;

const BLOCK: u8 = 0x84;
const FLAGS: u8 = 0x83;

/// A PLC with one memory for each area, which notes the areas that it is asked for.
struct Plc {
    memory: [Vec<u8>; 256],
    asked: Rc<RefCell<Vec<(char, u8, usize)>>>,
}

impl Transport for Plc {
    fn send(&mut self, request: &[u8]) -> Result<Vec<u8>, Error> {
        let area = request[27];
        let count = u16::from_be_bytes([request[23], request[24]]) as usize;
        let start = u32::from_be_bytes([0, request[28], request[29], request[30]]) as usize / 8;
        let memory = &mut self.memory[area as usize][start..start + count];
        let mut answer = vec![0; 25];
        answer[21] = 0xff;
        if request[17] == 5 {
            self.asked.borrow_mut().push(('w', area, count));
            memory.copy_from_slice(&request[35..]);
            answer.truncate(22);
        } else {
            self.asked.borrow_mut().push(('r', area, count));
            answer.extend_from_slice(memory);
        }
        Ok(answer)
    }

    fn pdu_length(&self) -> i32 {
        240
    }

    fn negotiate(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn connection_type(&self) -> Connection {
        Connection::PG
    }
}

fn main() {
    let asked = Rc::new(RefCell::new(vec![]));
    let plc = Plc { memory: std::array::from_fn(|_| vec![0; 400]), asked: asked.clone() };
    let mut client = Client::new(plc).unwrap();

    let angles: Vec<f32> = (0..100).map(|index| 1.0 + 0.25 * index as f32).collect();
    let mut bytes: Vec<u8> = angles.iter().flat_map(|angle| angle.to_be_bytes()).collect();
    client.ag_write(1, 0, 400, &mut bytes).unwrap();
    let mut buffer = vec![0; 400];
    client.ag_read(1, 0, 400, &mut buffer).unwrap();
    let read: Vec<f32> = buffer.chunks(4).map(|four| f32::from_be_bytes(four.try_into().unwrap())).collect();
    println!("Angles 54 to 58: {:?} are read as {:?}", &angles[53..58], &read[53..58]);
    println!("Asked: {:?}", asked.borrow());
    assert_eq!(read[..55], angles[..55]);
    assert!(read[56..].iter().all(|angle| *angle == 0.0));
    let (reads, writes): (Vec<_>, Vec<_>) = asked.borrow().iter().copied().partition(|(kind, ..)| *kind == 'r');
    assert_eq!(reads, [('r', BLOCK, 222), ('r', BLOCK, 178)]);
    assert_eq!(writes, [('w', BLOCK, 205), ('w', BLOCK, 195)]);

    // The last 178 bytes alone are read right.
    let mut rest = vec![0; 178];
    client.ag_read(1, 222, 178, &mut rest).unwrap();
    assert_eq!(rest, bytes[222..]);

    asked.borrow_mut().clear();
    client.mb_write(10, 1, &mut vec![0xff]).unwrap();
    client.mb_read(10, 1, &mut vec![0]).unwrap();
    println!("Flags are written and read in the areas {:x?}", asked.borrow());
    assert_eq!(*asked.borrow(), [('w', FLAGS, 1), ('r', BLOCK, 1)]);
}
RUST
timeout 280 cargo run --quiet
