# SPDX-License-Identifier: Apache-2.0
"""Decodes a message from its bytes on the wire; sequences of numbers become arrays."""

import dataclasses
import types
import typing

import numpy as np
from cyclonedds.idl.types import array, sequence

NUMBERS = {"int8": "i1", "uint8": "u1", "uint16": "u2", "int32": "i4", "uint32": "u4", "uint64": "u8", "float32": "f4",
           "float64": "f8"}
HEADER_BYTES = 4
LONGEST_ALIGNMENT = 8


class MalformedMessage(ValueError):
    """Bytes or values that no writer of the topic would send; the text says what is wrong, in one sentence."""


class _Reader:
    def __init__(self, data):
        if len(data) < HEADER_BYTES or data[0] != 0 or data[1] not in (0, 1):
            raise MalformedMessage(f"{len(data)} bytes without the header of plain CDR")
        self._data = memoryview(data)[HEADER_BYTES:]
        self._at = 0
        self._order = ">" if data[1] == 0 else "<"

    def numbers(self, code, count):
        """`count` numbers, read-only and in this machine's order of bytes."""
        dtype = np.dtype(self._order + code)
        if count > 0:
            alignment = min(dtype.itemsize, LONGEST_ALIGNMENT)
            self._at += -self._at % alignment
        values = np.frombuffer(self._take(count * dtype.itemsize), dtype=dtype)
        return values.astype(dtype.newbyteorder("="), copy=False)

    def number(self, code):
        return self.numbers(code, 1)[0].item()

    def text(self):
        size = self.number("u4")
        text = bytes(self._take(size))
        if size == 0 or text[-1] != 0:
            raise MalformedMessage("a text without its end")
        try:
            return text[:-1].decode()
        except UnicodeDecodeError as error:
            raise MalformedMessage(f"a text that is no UTF-8: {error}") from error

    def texts(self):
        count = self.number("u4")
        return [self.text() for _ in range(count)]  # each takes bytes, so a lie about the number ends soon

    def boolean(self):
        value = self.number("u1")
        if value > 1:
            raise MalformedMessage(f"a truth value of {value}")
        return value == 1

    def _take(self, size):
        if size > len(self._data) - self._at:
            raise MalformedMessage(f"the message ends after {len(self._data)} bytes, {size} more were expected at {self._at}")
        self._at += size
        return self._data[self._at - size:self._at]


def _number_code(declared):
    return NUMBERS[typing.get_args(declared)[1]]


def _value(reader, declared):
    if declared is str:
        return reader.text()
    if declared is bool:
        return reader.boolean()
    if dataclasses.is_dataclass(declared):
        return _struct(reader, declared)
    kind = typing.get_args(declared)[1]
    if isinstance(kind, array):
        return reader.numbers(_number_code(kind.subtype), kind.length)
    if isinstance(kind, sequence):
        return reader.texts() if kind.subtype is str else reader.numbers(_number_code(kind.subtype), reader.number("u4"))
    return reader.number(_number_code(declared))


def _struct(reader, message):
    return types.SimpleNamespace(**{name: _value(reader, declared) for name, declared in message.__annotations__.items()})


def decode(message, data):
    """@param message  a class of rds_map.messages. @param data  bytes, with the header of CDR.

    @return the fields by name: numbers, str, lists of str, arrays of numbers. @raises MalformedMessage
    """
    return _struct(_Reader(data), message)
