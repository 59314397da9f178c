# SPDX-License-Identifier: Apache-2.0
"""A WebSocket client of the standard library alone, for tests of the viewer."""

import base64
import os
import socket
import struct


class Refused(Exception):
    """The server answered the opening with this status."""


class WebSocket:
    def __init__(self, port, target="/socket", protocol="rds.view.v1", headers=(), limit_s=60):
        self.socket = socket.socket()
        self.socket.settimeout(limit_s)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)  # who does not read holds little
        self.socket.connect(("127.0.0.1", port))
        self.buffered = b""
        lines = [
            f"GET {target} HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade",
            f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}", "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Protocol: {protocol}",
            *headers, "", "",
        ]
        self.socket.sendall("\r\n".join(lines).encode())
        answer = b""
        while b"\r\n\r\n" not in answer:
            part = self.socket.recv(4096)
            if not part:
                break
            answer += part
        head, _, self.buffered = answer.partition(b"\r\n\r\n")
        if b" 101 " not in head.split(b"\r\n")[0]:
            self.socket.close()
            raise Refused(head.split(b"\r\n")[0].decode(errors="replace"))

    def _read(self, count):
        while len(self.buffered) < count:
            part = self.socket.recv(1 << 16)
            if not part:
                raise EOFError
            self.buffered += part
        data, self.buffered = self.buffered[:count], self.buffered[count:]
        return data

    def send(self, text, opcode=1):
        payload = text.encode() if isinstance(text, str) else text
        assert len(payload) < 126
        mask = os.urandom(4)
        self.socket.sendall(bytes([0x80 | opcode, 0x80 | len(payload)]) + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def receive(self):
        """The next message; pings are answered. Raises EOFError at the end."""
        while True:
            first, second = self._read(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack(">H", self._read(2))
            elif size == 127:
                (size,) = struct.unpack(">Q", self._read(8))
            payload = self._read(size)
            if first & 15 == 9:
                self.send(payload, opcode=10)
            elif first & 15 == 8:
                raise EOFError
            else:
                return payload

    def close(self):
        self.socket.close()
