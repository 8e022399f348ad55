#!/usr/bin/env python3
"""What netem does, for kernels without it: a relay of datagrams that loses, delays and doubles them, in both directions.

    lossy_relay.py LISTEN_HOST LISTEN_PORT TARGET_HOST TARGET_PORT LOSS DUPLICATE DELAY_S JITTER_S STALL_FILE

Runs until it is ended, and keeps in the file how many milliseconds it was late at most. It beats at a real-time priority where it may: a relay that waits for its turn would delay more
than it was told to.
"""
import heapq
import os
import random
import select
import socket
import sys
import time


def main() -> None:
    listen, target = (sys.argv[1], int(sys.argv[2])), (sys.argv[3], int(sys.argv[4]))
    loss, duplicate, delay_s, jitter_s = map(float, sys.argv[5:9])
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(70))
    except PermissionError:
        pass
    chance = random.Random(1)
    near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    near.bind(listen)
    far = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    far.connect(target)
    peer = None
    waiting: list[tuple[float, int, bool, bytes]] = []
    count = 0
    stall_ms = -1
    while True:
        patience_s = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        for ready in select.select([near, far], [], [], patience_s)[0]:
            try:
                data, sender = ready.recvfrom(65536)
            except ConnectionRefusedError:
                continue
            if ready is near:
                peer = sender
            for _ in range(2 if chance.random() < duplicate else 1):
                if chance.random() < loss:
                    continue
                due = time.monotonic() + delay_s + jitter_s * chance.uniform(-1, 1)
                heapq.heappush(waiting, (due, count, ready is near, data))
                count += 1
        while waiting and waiting[0][0] <= time.monotonic():
            due, _, outward, data = heapq.heappop(waiting)
            late_ms = int(1000 * (time.monotonic() - due))
            if late_ms > stall_ms:
                stall_ms = late_ms
                with open(sys.argv[9], "w", encoding="ascii") as file:
                    print(stall_ms, file=file)
            try:
                if outward:
                    far.send(data)
                elif peer is not None:
                    near.sendto(data, peer)
            except OSError:
                pass


main()
