#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# s7connector 2.1 (Java): storing one flag clears the seven beside it, and a time of -6 ms is read as 4294967290 ms.
#
# A bean names some variables of a data block: the flag DBX0.1, the speed DBD2 and the angle DBD10. Expected of store():
# these variables are written, or only those that are not null. What happens: all bytes from the first to the last one
# are sent, with zeros where the bean has nothing. A bean with the flag alone clears the other seven flags of its byte,
# one with the flag and the angle clears the speed limit between them and whatever else is there, and a speed that is
# left null is written as 0. A TIME, which has a sign in an S7 PLC, is read without one, a DWORD of 3 000 000 000
# counts, which has none, is read as -1 294 967 296. A connector with a memory takes the place of the PLC here.
# For us: store() only beans that cover each bit of their bytes; read a DWORD as DWORD & 0xFFFFFFFFL.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/src/main/java"
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>store</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>com.github.s7connector</groupId><artifactId>s7connector</artifactId>
      <version>2.1</version></dependency>
    <dependency><groupId>org.slf4j</groupId><artifactId>slf4j-nop</artifactId><version>1.7.36</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import com.github.s7connector.api.DaveArea;
import com.github.s7connector.api.S7Connector;
import com.github.s7connector.api.annotation.S7Variable;
import com.github.s7connector.api.factory.S7SerializerFactory;
import com.github.s7connector.impl.utils.S7Type;
import java.nio.ByteBuffer;
import java.util.Arrays;
import java.util.HexFormat;

public class Main {
    /** A PLC whose data block keeps what is written. */
    static class Memory implements S7Connector {
        final byte[] block;

        Memory(String bytes) {
            block = HexFormat.of().parseHex(bytes);
        }

        @Override
        public byte[] read(DaveArea area, int number, int bytes, int offset) {
            return Arrays.copyOfRange(block, offset, offset + bytes);
        }

        @Override
        public void write(DaveArea area, int number, int offset, byte[] bytes) {
            System.arraycopy(bytes, 0, block, offset, bytes.length);
        }

        @Override
        public void close() {
        }
    }

    public static class Enable {
        @S7Variable(type = S7Type.BOOL, byteOffset = 0, bitOffset = 1)
        public Boolean enable;
    }

    public static class Goal {
        @S7Variable(type = S7Type.BOOL, byteOffset = 0, bitOffset = 1)
        public Boolean enable;
        @S7Variable(type = S7Type.REAL, byteOffset = 2)
        public Float speed;
        @S7Variable(type = S7Type.REAL, byteOffset = 10)
        public Float angle;
    }

    public static class State {
        @S7Variable(type = S7Type.TIME, byteOffset = 0)
        public Long delay;
        @S7Variable(type = S7Type.DWORD, byteOffset = 4)
        public Long counts;
    }

    public static void main(String[] arguments) {
        // Eight flags, a spare byte, the speed, the speed limit and the angle as REAL.
        String before = "ff00" + "40000000" + "40400000" + "3f800000";
        Memory first = new Memory(before);
        Enable enable = new Enable();
        enable.enable = true;
        S7SerializerFactory.buildSerializer(first).store(enable, 1, 0);
        Memory second = new Memory(before);
        Goal goal = new Goal();
        goal.enable = true;
        goal.angle = 1.5f;
        S7SerializerFactory.buildSerializer(second).store(goal, 1, 0);
        ByteBuffer block = ByteBuffer.wrap(second.block);
        Memory third = new Memory("fffffffa" + "b2d05e00");
        State state = S7SerializerFactory.buildSerializer(third).dispense(State.class, 1, 0);
        System.out.println("flags ff: " + HexFormat.of().toHexDigits(first.block[0]) + "; speed 2, limit 3: "
                + block.getFloat(2) + ", " + block.getFloat(6) + "; angle 1.5: " + block.getFloat(10)
                + "; -6 ms: " + state.delay + "; 3000000000 counts: " + state.counts);
        if (first.block[0] != 2 || block.getFloat(2) != 0 || block.getFloat(6) != 0 || block.getFloat(10) != 1.5f
                || state.delay != 4294967290L || state.counts != -1294967296L) {
            System.exit(1);
        }
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
