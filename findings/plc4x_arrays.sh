#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# plc4j-driver-modbus 0.13.1 (Java): of three words or eleven flags of a drive only the first is read, with the code OK.
#
# Expected of the address holding-register:1:WORD[3]: three values, as UINT[3] gives them. What happens: the driver asks
# the drive for all three, and gives the first alone with the code OK; so does DWORD[2], and coil:1:BOOL[11] gives one
# flag of eleven, so that a fault in another is not seen. The 16 flags of a register, holding-register:4:BOOL[16], are
# given from its highest bit on, but holding-register:4:BOOL is its lowest bit: of a register of 1 the first flag of the
# array is false, and the single flag true. Arrays of INT and UINT and the like are right. A drive is simulated. The
# coils are issue 2060 of apache/plc4x, open since 2025-04-25.
# For us: read words as UINT and UDINT, and each coil by its own address.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/src/main/java"
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>arrays</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>org.apache.plc4x</groupId><artifactId>plc4j-driver-modbus</artifactId>
      <version>0.13.1</version></dependency>
    <dependency><groupId>org.slf4j</groupId><artifactId>slf4j-nop</artifactId><version>2.0.13</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import java.io.DataInputStream;
import java.io.DataOutputStream;
import java.net.InetAddress;
import java.net.ServerSocket;
import java.util.Arrays;
import java.util.List;
import java.util.concurrent.TimeUnit;
import org.apache.plc4x.java.api.PlcConnection;
import org.apache.plc4x.java.api.PlcDriverManager;
import org.apache.plc4x.java.api.types.PlcResponseCode;

public class Main {
    static final int[] REGISTERS = Arrays.copyOf(new int[] {1000, 2000, 3000, 1}, 32);
    static final String COILS = "10100000011";
    static PlcConnection connection;

    /** Answers Modbus TCP with the registers or the coils from the address that is asked for. */
    static void serve(ServerSocket server) {
        try (var socket = server.accept()) {
            var in = new DataInputStream(socket.getInputStream());
            var out = new DataOutputStream(socket.getOutputStream());
            while (true) {
                int transaction = in.readInt() >>> 16;
                in.readShort();
                int unit = in.readByte();
                int function = in.readByte();
                int address = in.readShort();
                int count = in.readShort();
                byte[] data = new byte[function == 1 ? (count + 7) / 8 : 2 * count];
                for (int place = 0; place < count; place++) {
                    if (function == 1) {
                        data[place / 8] |= (byte) ((COILS.charAt(address + place) - '0') << place % 8);
                    } else {
                        data[2 * place] = (byte) (REGISTERS[address + place] >> 8);
                        data[2 * place + 1] = (byte) REGISTERS[address + place];
                    }
                }
                out.writeInt(transaction << 16);
                out.writeShort(3 + data.length);
                out.write(new byte[] {(byte) unit, (byte) function, (byte) data.length});
                out.write(data);
            }
        } catch (java.io.IOException end) {
            // The connection was closed.
        }
    }

    static List<Object> read(String address) throws Exception {
        var request = connection.readRequestBuilder().addTagAddress("tag", address).build();
        var response = request.execute().get(20, TimeUnit.SECONDS);
        if (response.getResponseCode("tag") != PlcResponseCode.OK) {
            throw new IllegalStateException(address);
        }
        List<Object> values = List.copyOf(response.getAllObjects("tag"));
        System.out.println(address + ": " + values);
        return values;
    }

    public static void main(String[] arguments) throws Exception {
        var server = new ServerSocket(0, 1, InetAddress.getByName("127.0.0.1"));
        var drive = new Thread(() -> serve(server));
        drive.setDaemon(true);
        drive.start();
        String url = "modbus-tcp://127.0.0.1:" + server.getLocalPort();
        connection = PlcDriverManager.getDefault().getConnectionManager().getConnection(url);
        boolean same = read("holding-register:1:UINT[3]").equals(List.of(1000, 2000, 3000))
            & read("holding-register:1:INT[3]").size() == 3
            & read("holding-register:1:WORD[3]").equals(List.of(1000))
            & read("holding-register:1:DWORD[2]").equals(List.of(1000L * 65536 + 2000))
            & read("holding-register:1:UDINT[2]").size() == 2
            & read("coil:1:BOOL[11]").equals(List.of(true))
            & read("coil:2:BOOL").equals(List.of(false))
            & read("holding-register:4:BOOL").equals(List.of(true));
        List<Object> flags = read("holding-register:4:BOOL[16]");
        same &= flags.size() == 16 && flags.get(0).equals(false) && flags.get(15).equals(true);
        System.exit(same ? 0 : 1);
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
