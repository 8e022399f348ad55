"""Reads all that a run serves to the page, as a browser on another machine would: page_client.py PORT

Ends when the run does, and prints how many megabytes came.
"""

import json
import os
import socket
import struct
import sys


class Client:
    """A WebSocket that reads whole frames; what it sends is masked with zeros (RFC 6455, section 5.3)."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.bytes = 0
        self.file = self.socket.makefile("rb")
        self.socket.sendall(
            f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
            "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n".encode())
        if b" 101 " not in self.file.readline():
            sys.exit("page_client: refused")
        while self.file.readline().strip():
            pass

    def exactly(self, count):
        data = self.file.read(count)
        if len(data) < count:
            raise EOFError
        self.bytes += count
        return data

    def frame(self):
        first, second = self.exactly(2)
        size = second & 0x7F
        if size == 126:
            size, = struct.unpack(">H", self.exactly(2))
        elif size == 127:
            size, = struct.unpack(">Q", self.exactly(8))
        return first, self.exactly(size)

    def message(self):
        first, text = self.frame()
        while not first & 0x80:
            first, more = self.frame()
            text += more
        return text

    def send(self, text):
        self.socket.sendall(struct.pack(">BBHL", 0x81, 0x80 | 126, len(text), 0) + text.encode())


def main():
    os.nice(10)
    client = Client(int(sys.argv[1]))
    while True:
        text = client.message()
        if text[:1] == b"{" and json.loads(text).get("op") == "advertise":
            break
    channels = json.loads(text)["channels"]
    client.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": c["id"], "channelId": c["id"]} for c in channels]}))
    try:
        while True:
            client.message()
    except (EOFError, ConnectionError):
        print(f"{client.bytes / 1e6:.1f} MB of {len(channels)} channels")


main()
