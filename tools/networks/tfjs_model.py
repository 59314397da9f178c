# SPDX-License-Identifier: Apache-2.0
"""Reads TensorFlow.js graph models: weights, attributes, order of the nodes."""
import base64

import numpy as np


class ConversionError(Exception):
    """What in the model cannot be converted, in one sentence."""


def read_weights(model_path, manifest):
    """name → array, float32 or integer."""
    weights = {}
    for group in manifest:
        data = b"".join((model_path.parent / path).read_bytes() for path in group["paths"])
        offset = 0
        for entry in group["weights"]:
            stored = np.dtype(entry.get("quantization", {}).get("dtype", entry["dtype"])).newbyteorder("<")
            if stored not in (np.dtype("<f4"), np.dtype("<f2"), np.dtype("<i4")):
                raise ConversionError(f"weight {entry['name']}: stored as {stored}, expected float32, float16 or int32")
            count = int(np.prod(entry["shape"], dtype=np.int64))
            if offset + count * stored.itemsize > len(data):
                raise ConversionError(f"weight {entry['name']}: the weight file ends before it")
            array = np.frombuffer(data, stored, count, offset).reshape(entry["shape"])
            weights[entry["name"]] = array.astype(np.dtype(entry["dtype"]))
            offset += count * stored.itemsize
        if offset != len(data):
            raise ConversionError(f"{', '.join(group['paths'])}: {len(data) - offset} bytes after the last weight")
    return weights


def attribute(node, name, default=None):
    """The attribute as a Python value."""
    value = node.get("attr", {}).get(name)
    if value is None:
        return default
    kind, content = next(iter(value.items()))
    if kind == "s":
        return base64.b64decode(content).decode()
    if kind == "list":
        return [int(i) for i in content.get("i", [])]
    return {"i": int, "f": float, "b": bool}[kind](content)


def in_topological_order(nodes):
    """Nodes after all nodes they read; otherwise in the order of the file."""
    by_name = {node["name"]: node for node in nodes}
    seen, order = set(), []
    for start in by_name:
        stack = [(start, False)]
        while stack:
            name, inputs_done = stack.pop()
            if inputs_done:
                order.append(by_name[name])
            elif name in by_name and name not in seen:
                seen.add(name)
                stack.append((name, True))
                inputs = by_name[name].get("input", [])
                stack.extend((i.removeprefix("^").partition(":")[0], False) for i in reversed(inputs))
    return order
