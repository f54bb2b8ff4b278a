#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# periph.io/x/devices/v3 3.7.4 (Go): an ADXL345 at 1 g is read as 0, at 0.5 g as -32768, and the goal -1 of a Tic as
# 4294967295.
#
# The sensor counts 256 per g, in two bytes. Expected of Update() at 1 g: 256. What happens: each byte is already
# shifted up by 8 bits where it is read from SPI, and the upper one once more, out of its 16 bits. What remains is the
# lower byte times 256: 0 for 256, -32768 for 128 and -256 for 255, so that a vibration of a few counts is the largest
# one. Expected of a Tic whose ramp goes to -1: GetActingTargetPosition() is -1, as GetTargetPosition() is; the comment
# at its register says int32. What happens: it is unsigned.
# For us: read the registers 0x32 to 0x37 yourself; subtract 2^32 from a target beyond 2^31.
#
# Exit code 0: still so. Needs go; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GOMODCACHE="$folder/modules" GOFLAGS=-modcacherw
go mod init example.org/adxl345 2> log
go get periph.io/x/devices/v3/adxl345@v3.7.4 periph.io/x/devices/v3/tic@v3.7.4 2>> log || { cat log; exit 1; }
cat > main.go <<'GO'
package main

import (
	"encoding/binary"
	"fmt"
	"os"

	"periph.io/x/conn/v3"
	"periph.io/x/conn/v3/physic"
	"periph.io/x/conn/v3/spi"
	"periph.io/x/devices/v3/adxl345"
	"periph.io/x/devices/v3/tic"
)

// sensor answers as an ADXL345 on SPI: nothing during the address, then the register.
type sensor struct {
	registers [64]byte
}

func (s *sensor) String() string                                            { return "sensor" }
func (s *sensor) Duplex() conn.Duplex                                       { return conn.Full }
func (s *sensor) TxPackets([]spi.Packet) error                              { return nil }
func (s *sensor) Connect(physic.Frequency, spi.Mode, int) (spi.Conn, error) { return s, nil }

func (s *sensor) Tx(written, read []byte) error {
	if len(read) == 2 {
		read[0], read[1] = 0, s.registers[written[0]&0x3f]
	}
	return nil
}

// motor answers as a Tic on I2C whose target and acting target are -1.
type motor struct{}

func (motor) String() string                  { return "motor" }
func (motor) SetSpeed(physic.Frequency) error { return nil }

func (motor) Tx(_ uint16, _, read []byte) error {
	for place := range read {
		read[place] = 0xff
	}
	if len(read) == 1 {
		read[0] = byte(tic.PlanningModeTargetPosition)
	}
	return nil
}

func main() {
	board := &sensor{}
	board.registers[adxl345.DeviceID] = adxl345.Adxl345
	device, err := adxl345.NewSpi(board, &adxl345.DefaultOpts)
	must(err)
	right := true
	for counts, expected := range map[int16]int16{256: 0, 128: -32768, 255: -256, -1: -256, 1: 256} {
		binary.LittleEndian.PutUint16(board.registers[adxl345.DataX0:], uint16(counts))
		found := device.Update().X
		fmt.Println(counts, "counts are read as", found)
		right = right && found == expected
	}
	drive, err := tic.NewI2C(motor{}, tic.TicT825, tic.I2CAddr)
	must(err)
	target, err := drive.GetTargetPosition()
	must(err)
	acting, err := drive.GetActingTargetPosition()
	must(err)
	fmt.Println("target", target, "acting target", acting)
	if !right || target != -1 || acting != 4294967295 {
		os.Exit(1)
	}
}

func must(err error) {
	if err != nil {
		panic(err)
	}
}
GO
timeout 280 go run .
