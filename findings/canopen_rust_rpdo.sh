#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen_rust 0.1.3 (Rust): a torque of 100 in an RPDO is taken as 25600, and a stop of all nodes is not heard.
#
# A drive has a target torque, a target position and a target speed in three RPDOs. Expected: the object dictionary has
# the numbers that were sent, with their bytes from low to high, as they arrive by SDO of the same library. What
# happens: their bytes are exchanged, so that 100 is 25600. Two kinds of goals are lost without an error. By CiA 301, an
# RPDO of type 255 takes effect when it is received, and its event timer only watches over it. What happens: without an
# event timer, its goal is never taken. An access type "rww" in the .eds is one of the six of CiA 306. What happens: it
# is taken as neither readable nor writable, so that the goal is lost, and SDO refuses to read the object. The NMT
# command to stop with node 0 is for all nodes. Expected: the drive stops. What happens: it stays operational, as it
# only hears its own number.
# For us: send goals by SDO, and stop each node by its number, before a wrong motion is taken for a gear's.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "drive"
version = "0.1.0"
edition = "2021"
[dependencies]
canopen_rust = "=0.1.3"
embedded-can = "=0.4.1"
nb = "1"
TOML
cat > src/main.rs <<'RUST'
use canopen_rust::node::Node;
use embedded_can::{nb::Can, ErrorKind, Frame, Id, StandardId};
use std::{cell::RefCell, collections::VecDeque, rc::Rc};

const NODE: u16 = 5;

#[derive(Clone, Debug)]
struct Message(u16, Vec<u8>);

impl Frame for Message {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let Id::Standard(id) = id.into() else { return None };
        Some(Message(id.as_raw(), data.to_vec()))
    }
    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }
    fn is_extended(&self) -> bool {
        false
    }
    fn is_remote_frame(&self) -> bool {
        false
    }
    fn id(&self) -> Id {
        StandardId::new(self.0).unwrap().into()
    }
    fn dlc(&self) -> usize {
        self.1.len()
    }
    fn data(&self) -> &[u8] {
        &self.1
    }
}

#[derive(Default)]
struct Queues {
    to_node: VecDeque<Message>,
    from_node: Vec<Message>,
}

struct Bus(Rc<RefCell<Queues>>);

impl Can for Bus {
    type Frame = Message;
    type Error = ErrorKind;
    fn transmit(&mut self, frame: &Message) -> nb::Result<Option<Message>, ErrorKind> {
        self.0.borrow_mut().from_node.push(frame.clone());
        Ok(None)
    }
    fn receive(&mut self) -> nb::Result<Message, ErrorKind> {
        self.0.borrow_mut().to_node.pop_front().ok_or(nb::Error::WouldBlock)
    }
}

fn variable(section: &str, name: &str, data_type: u16, access: &str, value: &str) -> String {
    format!("[{section}]\nParameterName={name}\nObjectType=0x7\nDataType={data_type:#06x}\nAccessType={access}\nDefaultValue={value}\nPDOMapping=1\n\n")
}

fn rpdo(number: u16, kind: u8, timer: u16, mapped: &str) -> String {
    let record = |index: u16, name: &str, length: u8| {
        format!("[{index:04X}]\nParameterName={name}{number}\nObjectType=0x9\nSubNumber={length}\n\n")
    };
    let (communication, mapping) = (0x1400 + number, 0x1600 + number);
    let sub = |index: u16, sub: u8| format!("{index:04X}sub{sub:X}");
    record(communication, "RPDO communication ", 6)
        + &variable(&sub(communication, 0), "Highest", 5, "ro", "5")
        + &variable(&sub(communication, 1), "COB-ID", 7, "rw", &format!("{:#x}", 0x200 + 0x100 * number + NODE))
        + &variable(&sub(communication, 2), "Type", 5, "rw", &kind.to_string())
        + &variable(&sub(communication, 5), "Event timer", 6, "rw", &timer.to_string())
        + &record(mapping, "RPDO mapping ", 2)
        + &variable(&sub(mapping, 0), "Number", 5, "rw", "1")
        + &variable(&sub(mapping, 1), "Mapped", 7, "rw", mapped)
}

struct Drive {
    node: Node<Bus>,
    queues: Rc<RefCell<Queues>>,
}

impl Drive {
    fn send(&mut self, id: u16, data: &[u8]) -> Vec<Message> {
        self.queues.borrow_mut().to_node.push_back(Message(id, data.to_vec()));
        self.node.process_one_frame();
        self.node.event_timer_callback();
        self.queues.borrow_mut().from_node.drain(..).collect()
    }
    /// The value of an object by SDO, or the code of its refusal.
    fn read(&mut self, index: u16) -> Result<i32, u32> {
        let [low, high] = index.to_le_bytes();
        let answers = self.send(0x600 + NODE, &[0x40, low, high, 0, 0, 0, 0, 0]);
        let answer = answers.iter().find(|message| message.0 == 0x580 + NODE).unwrap();
        let value = i32::from_le_bytes(answer.1[4..8].try_into().unwrap());
        if answer.1[0] == 0x80 { Err(value as u32) } else { Ok(value) }
    }
    /// The NMT state as its heartbeat says it.
    fn state(&mut self) -> u8 {
        self.send(0x600 + NODE, &[0x2B, 0x17, 0x10, 0, 1, 0, 0, 0]);
        let heartbeats = self.send(0x7FF, &[]);
        heartbeats.iter().find(|message| message.0 == 0x700 + NODE).unwrap().1[0]
    }
}

fn drive(timer: u16) -> Drive {
    let eds = variable("1017", "Heartbeat", 6, "rw", "0")
        + &variable("6071", "Target torque", 3, "rw", "0")
        + &variable("607A", "Target position", 4, "rww", "0")
        + &variable("60FF", "Target velocity", 4, "rw", "0")
        + &rpdo(0, 1, 0, "0x60710010")
        + &rpdo(1, 1, 0, "0x607A0020")
        + &rpdo(2, 255, timer, "0x60FF0020");
    let queues = Rc::new(RefCell::new(Queues::default()));
    let node = Node::new(NODE as u8, &eds, Bus(queues.clone())).unwrap();
    Drive { node, queues }
}

fn main() {
    for timer in [0, 1] {
        let mut drive = drive(timer);
        drive.send(0, &[1, NODE as u8]);
        drive.send(0x200 + NODE, &100i16.to_le_bytes());
        drive.send(0x300 + NODE, &20000i32.to_le_bytes());
        drive.send(0x400 + NODE, &3000i32.to_le_bytes());
        drive.send(0x080, &[]);
        for _ in 0..1000 {
            drive.send(0x080, &[]);
        }
        let found = (drive.read(0x6071), drive.read(0x607A), drive.read(0x60FF));
        println!("event timer {timer}: torque {:?}, position {:x?}, speed {:?}", found.0, found.1, found.2);
        assert_eq!(found, (Ok(25600), Err(0x0601_0001), Ok(if timer == 0 { 0 } else { 3000i32.swap_bytes() })));
        drive.send(0x600 + NODE, &[0x2B, 0x71, 0x60, 0, 100, 0, 0, 0]);
        assert_eq!(drive.read(0x6071), Ok(100));
    }
    let mut drive = drive(0);
    let mut states = Vec::new();
    for (command, node) in [(1, 0), (1, NODE as u8), (2, 0), (2, NODE as u8)] {
        drive.send(0, &[command, node]);
        states.push(drive.state());
        println!("after NMT command {command} to node {node}: state {}", states[states.len() - 1]);
    }
    assert_eq!(states, [0, 5, 5, 4]);
}
RUST
timeout 280 cargo run --quiet
