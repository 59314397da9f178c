# SPDX-License-Identifier: Apache-2.0
"""A participant made of plain RTPS messages on 127.0.0.1 that can say what no DDS library would."""

import contextlib
import os
import socket
import struct
import time

VENDOR = b"\x01\x0f"
TO_ANYBODY = bytes(4)
PARTICIPANT, SUBSCRIPTIONS_WRITER, PARTICIPANTS_WRITER = b"\x00\x00\x01\xc1", b"\x00\x00\x04\xc2", b"\x00\x01\x00\xc2"
TYPE_REQUEST_WRITER, TYPE_REPLY_WRITER = b"\x00\x03\x00\xc3", b"\x00\x03\x01\xc3"
USER_READER = b"\x00\x00\x01\x04"
ALL_BUILTIN_ENDPOINTS = 0x0000FC3F  # discovery, liveliness, type lookup
PID_TYPE_INFORMATION = 0x75
FRAGMENT = 60000  # bytes


def text(value):
    data = value.encode() + b"\0"
    return struct.pack("<I", len(data)) + data


def parameter(identifier, data):
    data += bytes(-len(data) % 4)
    return struct.pack("<HH", identifier, len(data)) + data


def parameter_list(*parameters):
    return b"\x00\x03\x00\x00" + b"".join(parameters) + b"\x01\x00\x00\x00"


class Stranger:
    """Announces itself to the participants 0 to 3 of a domain; what it says is repeated until it hears what it waits for."""

    def __init__(self, domain):
        self.prefix = VENDOR + os.urandom(10)
        self.ports = [7410 + 250 * domain + 2 * i for i in range(4)]
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.2)
        self.locator = struct.pack("<iI", 1, self.socket.getsockname()[1]) + bytes(12) + b"\x7f\x00\x00\x01"
        self.written = {}  # messages per writer
        self.said = []  # all that was sent

    def close(self):
        self.socket.close()

    def announce(self):
        data = parameter_list(
            parameter(0x15, b"\x02\x02"), parameter(0x16, VENDOR), parameter(0x50, self.prefix + PARTICIPANT),
            parameter(0x31, self.locator), parameter(0x32, self.locator), parameter(0x02, struct.pack("<iI", 100, 0)),
            parameter(0x58, struct.pack("<I", ALL_BUILTIN_ENDPOINTS)))
        self.publish(PARTICIPANTS_WRITER, data, reliable=False)

    def subscribe(self, topic, type_name, type_information):
        """Announces a best-effort reader with these bytes as its type information."""
        self.publish(SUBSCRIPTIONS_WRITER, parameter_list(
            parameter(0x5A, self.prefix + USER_READER), parameter(0x05, text(topic)), parameter(0x07, text(type_name)),
            parameter(0x2F, self.locator), parameter(PID_TYPE_INFORMATION, type_information)))

    def publish(self, writer, payload, reliable=True):
        number = self.written[writer] = self.written.get(writer, 0) + 1
        messages = [self._data(writer, number, payload)] if len(payload) <= FRAGMENT else list(self._fragments(writer, number, payload))
        if reliable:
            body = TO_ANYBODY + writer + struct.pack("<iIiII", 0, 1, 0, number, number)
            messages.append(struct.pack("<BBH", 0x07, 3, len(body)) + body)
        for message in messages:
            self._send(message)
        self.said += messages

    def hears(self, content, seconds=30):
        """True if somebody sends a message with this content here."""
        end = time.monotonic() + seconds
        repeat = time.monotonic() + 1
        while time.monotonic() < end:
            with contextlib.suppress(socket.timeout):
                if content in self.socket.recv(65536):
                    return True
            if time.monotonic() > repeat:
                repeat = time.monotonic() + 1
                for message in self.said:
                    self._send(message)
        return False

    @staticmethod
    def _data(writer, number, payload):
        body = struct.pack("<HH", 0, 16) + TO_ANYBODY + writer + struct.pack("<iI", 0, number) + payload
        body += bytes(-len(body) % 4)
        return struct.pack("<BBH", 0x15, 5, len(body)) + body

    @staticmethod
    def _fragments(writer, number, payload):
        for i in range(0, len(payload), FRAGMENT):
            body = struct.pack("<HH", 0, 28) + TO_ANYBODY + writer + struct.pack("<iI", 0, number)
            body += struct.pack("<IHHI", i // FRAGMENT + 1, 1, FRAGMENT, len(payload)) + payload[i:i + FRAGMENT]
            body += bytes(-len(body) % 4)
            yield struct.pack("<BBH", 0x16, 1, len(body)) + body

    def _send(self, submessage):
        message = b"RTPS\x02\x02" + VENDOR + self.prefix + submessage
        for port in self.ports:
            self.socket.sendto(message, ("127.0.0.1", port))
