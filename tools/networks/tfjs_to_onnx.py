# SPDX-License-Identifier: Apache-2.0
"""TensorFlow operators of convolutional networks as ONNX nodes."""
import collections
import dataclasses

import numpy as np
import onnx
from onnx import helper, numpy_helper

from tfjs_model import ConversionError, attribute

NHWC = (0, 2, 3, 1)  # of an NCHW tensor
OPSET = 11           # the newest whose Split and Resize OpenCV 4.6 reads without doubt
IR_VERSION = 6
LOWEST = -1e30       # a padding value below this one is minus infinity


@dataclasses.dataclass(frozen=True)
class Value:
    """A TensorFlow tensor: the ONNX tensor `name` (of `shape`) transposed by `permutation`, after padding it."""
    name: str
    shape: tuple
    permutation: tuple
    pads: tuple = ()          # (before, after) per axis of the ONNX tensor, not yet applied
    pad_value: float = 0.0
    bare_convolution: bool = False  # made by a convolution that has no bias yet


class Converter:
    """Walks a TensorFlow graph in its topological order and writes ONNX nodes."""

    def __init__(self, weights, readers):
        self.constants = dict(weights)
        self.readers = readers  # TensorFlow name → how many inputs of nodes it is
        self.values = {}  # TensorFlow name → Value
        self.nodes = []
        self.initializers = {}
        self.inputs = []
        self.outputs = []
        self.counts = collections.Counter()

    # Building blocks

    def emit(self, operator, inputs, shape, permutation, outputs=1, **attributes):
        """One ONNX node; `shape` is that of its (first) output."""
        self.counts[operator] += 1
        name = f"{operator.lower()}_{self.counts[operator]}"
        names = [name] if outputs == 1 else [f"{name}_{i}" for i in range(outputs)]
        self.nodes.append(helper.make_node(operator, inputs, names, name=name, **attributes))
        return Value(names[0], tuple(int(n) for n in shape), permutation)

    def constant(self, name, array):
        self.initializers[name] = numpy_helper.from_array(np.ascontiguousarray(array), name)
        return name

    def plain(self, value, what):
        """The value, which must have no padding left to apply."""
        if value.pads:
            raise ConversionError(f"{what}: a padding that no convolution or pooling follows")
        return value

    def materialised(self, value, what):
        """The value with its transposition really done."""
        self.plain(value, what)
        if value.permutation == tuple(range(len(value.shape))):
            return value
        shape = [value.shape[i] for i in value.permutation]
        return self.emit("Transpose", [value.name], shape, tuple(range(len(shape))), perm=value.permutation)

    # Operators: each takes the node, its Values or arrays

    def op_placeholder(self, node):
        shape = tuple(int(d["size"]) for d in node["attr"]["shape"]["shape"]["dim"])
        self.inputs.append(helper.make_tensor_value_info("data", onnx.TensorProto.FLOAT, shape))
        return Value("data", shape, tuple(range(len(shape))))

    def op_transpose(self, node, x, permutation):
        return dataclasses.replace(x, permutation=tuple(x.permutation[int(i)] for i in permutation),
                                   bare_convolution=False)

    def op_pad(self, node, x, paddings, pad_value=np.float32(0)):
        self.plain(x, node["name"])
        pads = [None] * len(x.shape)
        for axis, before_after in zip(x.permutation, paddings.tolist()):
            pads[axis] = tuple(before_after)
        return dataclasses.replace(x, pads=tuple(pads), pad_value=float(pad_value), bare_convolution=False)

    def spatial(self, node, x, window, strides, dilations, allowed_padding):
        """Attributes shared by convolution and pooling, and the output's height and width."""
        if x.permutation != NHWC or attribute(node, "data_format") != "NHWC":
            raise ConversionError(f"{node['name']}: expected NHWC between transpositions")
        if attribute(node, "padding") != "VALID":
            raise ConversionError(f"{node['name']}: expected padding VALID behind an explicit one")
        pads = x.pads or ((0, 0),) * 4
        if pads[:2] != ((0, 0), (0, 0)) or (x.pads and not allowed_padding(x.pad_value)):
            raise ConversionError(f"{node['name']}: a padding of batch, channels or with another value")
        size = [(n + sum(p) - d * (k - 1) - 1) // s + 1
                for n, p, k, s, d in zip(x.shape[2:], pads[2:], window, strides, dilations)]
        return size, {"kernel_shape": list(window), "strides": list(strides),
                      "pads": [pads[2][0], pads[3][0], pads[2][1], pads[3][1]]}

    def op_conv2d(self, node, x, kernel):
        strides = attribute(node, "strides")[1:3]
        dilations = attribute(node, "dilations", [1] * 4)[1:3]
        size, attributes = self.spatial(node, x, kernel.shape[:2], strides, dilations, lambda v: v == 0)
        if kernel.shape[2] != x.shape[1]:
            raise ConversionError(f"{node['name']}: a convolution in groups")
        weight = self.constant(f"weight_{self.counts['Conv'] + 1}", kernel.transpose(3, 2, 0, 1).astype(np.float32))
        value = self.emit("Conv", [x.name, weight], (x.shape[0], kernel.shape[3], *size), NHWC, dilations=dilations,
                          **attributes)
        return dataclasses.replace(value, bare_convolution=True)

    def op_maxpool(self, node, x):
        window, strides = attribute(node, "ksize")[1:3], attribute(node, "strides")[1:3]
        size, attributes = self.spatial(node, x, window, strides, (1, 1), lambda v: v < LOWEST)
        return self.emit("MaxPool", [x.name], (*x.shape[:2], *size), NHWC, **attributes)

    def op_add(self, node, a, b):
        if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
            return a + b
        if isinstance(b, np.ndarray):
            return self.add_bias(node, a, b)
        self.plain(a, node["name"])
        self.plain(b, node["name"])
        if a.shape != b.shape or a.permutation != b.permutation:
            raise ConversionError(f"{node['name']}: an addition of tensors of different shapes")
        return self.emit("Add", [a.name, b.name], a.shape, a.permutation)

    def add_bias(self, node, x, bias):
        if not x.bare_convolution or self.readers[node["input"][0]] != 1 or bias.size != x.shape[1]:
            raise ConversionError(f"{node['name']}: a constant that is not added directly to a convolution")
        convolution = next(n for n in self.nodes if n.output[0] == x.name)
        name = convolution.input[1].replace("weight", "bias")
        convolution.input.append(self.constant(name, bias.reshape(-1).astype(np.float32)))
        return dataclasses.replace(x, bare_convolution=False)

    def op_leakyrelu(self, node, x):
        self.plain(x, node["name"])
        return self.emit("LeakyRelu", [x.name], x.shape, x.permutation, alpha=attribute(node, "alpha", 0.2))

    def op_sigmoid(self, node, x):
        self.plain(x, node["name"])
        return self.emit("Sigmoid", [x.name], x.shape, x.permutation)

    def op_concatv2(self, node, *inputs):
        *parts, axis = inputs
        for part in parts:
            self.plain(part, node["name"])
        if len({part.permutation for part in parts}) != 1:
            raise ConversionError(f"{node['name']}: a concatenation of tensors of different layouts")
        axis = parts[0].permutation[int(axis)]
        shape = list(parts[0].shape)
        shape[axis] = sum(part.shape[axis] for part in parts)
        return self.emit("Concat", [part.name for part in parts], shape, parts[0].permutation, axis=axis)

    def op_splitv(self, node, x, sizes, axis):
        self.plain(x, node["name"])
        axis = x.permutation[int(axis)]
        sizes = [int(n) for n in sizes]
        first = self.emit("Split", [x.name], x.shape, x.permutation, outputs=len(sizes), axis=axis, split=sizes)
        names = list(self.nodes[-1].output)
        shapes = [x.shape[:axis] + (n,) + x.shape[axis + 1:] for n in sizes]
        return [dataclasses.replace(first, name=n, shape=s) for n, s in zip(names, shapes)]

    def op_resizebilinear(self, node, x, size):
        self.plain(x, node["name"])
        if x.permutation != NHWC or not attribute(node, "half_pixel_centers") or attribute(node, "align_corners"):
            raise ConversionError(f"{node['name']}: expected NHWC and half-pixel centres")
        shape = (*x.shape[:2], *(int(n) for n in size))
        index = self.counts["Resize"] + 1
        scales = np.array([b / a for a, b in zip(x.shape, shape)], np.float32)
        inputs = [x.name, self.constant("no_region", np.empty(0, np.float32)),
                  self.constant(f"scales_{index}", scales)]
        return self.emit("Resize", inputs, shape, NHWC, mode="linear", coordinate_transformation_mode="half_pixel")

    def op_reshape(self, node, x, shape):
        x = self.materialised(x, node["name"])
        shape = np.asarray(shape, np.int64)
        known = int(np.prod(shape[shape >= 0]))
        final = [int(n) if n >= 0 else int(np.prod(x.shape)) // known for n in shape]
        name = self.constant(f"shape_{self.counts['Reshape'] + 1}", shape)
        return self.emit("Reshape", [x.name, name], final, tuple(range(len(final))))

    def op_sparsetodense(self, node, indices, shape, values, default):
        dense = np.full(shape.astype(int), default)
        for index, value in zip(indices, np.broadcast_to(values, len(indices))):
            dense[tuple(np.atleast_1d(index))] = value
        return dense

    def op_identity(self, node, x):
        return self.materialised(x, node["name"]) if isinstance(x, Value) else x

    # The walk

    def lookup(self, name):
        name = name.removesuffix(":0")
        if name in self.constants:
            return self.constants[name]
        base, _, index = name.partition(":")
        value = self.values[base]
        return value[int(index or 0)] if isinstance(value, list) else value

    def convert(self, node):
        operator = node["op"].lower()
        operator = {"padv2": "pad", "addv2": "add"}.get(operator, operator)
        method = getattr(self, f"op_{operator}", None)
        if method is None:
            raise ConversionError(f"{node['name']}: operator {node['op']} is not supported")
        result = method(node, *(self.lookup(i) for i in node.get("input", []) if not i.startswith("^")))
        (self.constants if isinstance(result, np.ndarray) else self.values)[node["name"]] = result

    def finish(self, output_names, size):
        """The model, for inputs of `size` (height, width)."""
        for i, name in enumerate(output_names):
            value = self.lookup(name)
            for node in self.nodes:
                node.input[:] = [f"output_{i}" if n == value.name else n for n in node.input]
                node.output[:] = [f"output_{i}" if n == value.name else n for n in node.output]
            self.outputs.append(helper.make_tensor_value_info(f"output_{i}", onnx.TensorProto.FLOAT, None))
        for dimension, pixels in zip(self.inputs[0].type.tensor_type.shape.dim[2:], size):
            dimension.dim_value = pixels or dimension.dim_value
        graph = helper.make_graph(self.nodes, "network", self.inputs, self.outputs, list(self.initializers.values()))
        model = helper.make_model(graph, producer_name="rds-slam", ir_version=IR_VERSION,
                                  opset_imports=[helper.make_operatorsetid("", OPSET)])
        try:
            model = onnx.shape_inference.infer_shapes(model, strict_mode=True, data_prop=True)
        except onnx.shape_inference.InferenceError as error:
            raise ConversionError("expected a size of the input that the network's strides divide") from error
        del model.graph.value_info[:]
        onnx.checker.check_model(model, full_check=True)
        return model
