#!/usr/bin/env python3
"""A game controller of somebody else's, written down from the protocol: control data of version 20 to port 3838, return
data of version 4 at port 3939. It leads a striker alone through a kick-off, takes it off and ends the match, and is
content when the robot answered as it should."""
import socket
import struct
import sys
import time

INITIAL, READY, SET, PLAYING, FINISHED = range(5)


def team(number, colour, penalised):
    robots = b"".join(struct.pack("<3B", 1 if player in penalised else 0, 30, 0) for player in range(1, 21))
    return struct.pack("<6B2H", number, colour, colour + 1, 0, 0, 0, 0, 12000) + robots


def packet(number, state, secondary_s=0, first=1, penalised=()):
    head = struct.pack("<4s10B2h", b"RGme", 20, number & 255, 1, 1, 0, 0, state, 0, first, 1, 300, secondary_s)
    data = head + team(1, 0, penalised) + team(2, 1, ())
    assert len(data) == 158
    return data


def main():
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    back = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    back.bind(("127.0.0.1", 3939))
    back.setblocking(False)
    plan = [
        (2, {"state": INITIAL}),
        (10, {"state": READY}),
        (2, {"state": SET}),
        (6, {"state": PLAYING}),
        (3, {"state": PLAYING, "penalised": (1,)}),
        (3, {"state": FINISHED, "first": 0}),
    ]
    number, answers = 0, []
    for seconds, what in plan:
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            left_s = int(end_s - time.monotonic()) if what["state"] == READY else 0
            out.sendto(packet(number, secondary_s=left_s, **what), ("127.0.0.1", 3838))
            number += 1
            time.sleep(0.5)
            while True:
                try:
                    answers.append((what, back.recv(100)))
                except BlockingIOError:
                    break
    print(f"{number} packets, {len(answers)} answers")
    assert len(answers) > 10, "the robot answers once a second"
    for _, data in answers:
        magic, version, player, own, fallen, x_mm, y_mm, *_ = struct.unpack("<4s4B3f3f", data)
        assert (magic, version, player, own) == (b"RGrt", 4, 1, 1), data
        assert fallen in (0, 1) and abs(x_mm) < 7000 and abs(y_mm) < 5000, data
    off = [struct.unpack("<f", data[12:16])[0] for what, data in answers if what.get("penalised")]
    assert abs(off[-1]) > 3000, f"a robot with a penalty stands at the touchline, not at y = {off[-1]} mm"


if __name__ == "__main__":
    sys.exit(main())
