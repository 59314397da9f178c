#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The converter on models small enough to compute by hand. Exit status 77 (skipped) without the package onnx."""
import base64
import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy as np
    from onnx.reference import ReferenceEvaluator
except ImportError as missing:
    print(f"skipped: {missing}; pip install -r tools/networks/requirements.txt")
    sys.exit(77)

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parents[4] / "tools" / "networks"))
import convert_tfjs  # noqa: E402  (found through the line above)
from tfjs_model import ConversionError, in_topological_order  # noqa: E402

TO_NHWC, TO_NCHW = [0, 2, 3, 1], [0, 3, 1, 2]


def text(value):
    return {"s": base64.b64encode(value.encode()).decode()}


def integers(*values):
    return {"list": {"i": [str(v) for v in values]}}


def node(name, op, *inputs, **attr):
    return {"name": name, "op": op, "input": list(inputs), "attr": attr}


class SmallModel:
    """A graph model with float16 weights in a folder of its own."""

    def __init__(self, nodes, constants, output, channels=2, size=4):
        shape = {"shape": {"dim": [{"size": str(n)} for n in (1, channels, size, size)]}}
        self.nodes = [node("x", "Placeholder", shape=shape), *nodes]
        self.constants = constants
        self.output = output

    def convert(self, size=(None, None), cut=0):
        with tempfile.TemporaryDirectory() as folder:
            data, entries = b"", []
            for name, array in self.constants.items():
                array = np.asarray(array)
                entry = {"name": name, "shape": list(array.shape), "dtype": "int32"}
                if array.dtype.kind == "f":
                    entry.update(dtype="float32", quantization={"dtype": "float16"})
                entries.append(entry)
                data += array.astype("<f2" if array.dtype.kind == "f" else "<i4").tobytes()
            path = pathlib.Path(folder)
            (path / "w.bin").write_bytes(data[:len(data) - cut])
            (path / "m.json").write_text(json.dumps({
                "format": "graph-model", "signature": {"outputs": {self.output: {}}},
                "modelTopology": {"node": [*self.nodes, *(node(n, "Const") for n in self.constants)]},
                "weightsManifest": [{"paths": ["w.bin"], "weights": entries}]}))
            return convert_tfjs.convert_model(path / "m.json", size)


def run(model, x):
    return ReferenceEvaluator(model).run(None, {"data": x})[0]


def convolution_model(kernel, bias):
    return SmallModel(
        [node("padded", "Pad", "x", "paddings"),
         node("nhwc", "Transpose", "padded", "to_nhwc"),
         node("conv", "Conv2D", "nhwc", "kernel", strides=integers(1, 2, 2, 1), dilations=integers(1, 1, 1, 1),
              padding=text("VALID"), data_format=text("NHWC")),
         node("sum", "Add", "conv", "bias"),
         node("nchw", "Transpose", "sum", "to_nchw"),
         node("leaky", "LeakyRelu", "nchw", alpha={"f": 0.1}),
         node("out", "Identity", "leaky")],
        {"paddings": [[0, 0], [0, 0], [1, 1], [1, 1]], "to_nhwc": TO_NHWC, "to_nchw": TO_NCHW, "kernel": kernel,
         "bias": bias}, "out:0")


def expected_convolution(x, kernel, bias):
    padded = np.pad(x, ((0, 0), (0, 0), (1, 1), (1, 1)))
    height, width = (n // 2 for n in x.shape[2:])
    out = np.zeros((1, kernel.shape[3], height, width), np.float32)
    for row in range(height):
        for column in range(width):
            window = padded[0, :, 2 * row:2 * row + 3, 2 * column:2 * column + 3]
            out[0, :, row, column] = np.einsum("cij,ijco->o", window, kernel) + bias
    return np.where(out > 0, out, 0.1 * out)


class Conversion(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.kernel = random.integers(-8, 8, (3, 3, 2, 5)).astype(np.float32) / 8  # exact in float16
        self.bias = random.integers(-8, 8, 5).astype(np.float32) / 8
        self.random = random

    def input(self, height, width):
        return self.random.normal(size=(1, 2, height, width)).astype(np.float32)

    def test_convolution_with_padding_and_bias_is_one_node_with_the_same_result(self):
        model = convolution_model(self.kernel, self.bias).convert()
        self.assertEqual([n.op_type for n in model.graph.node], ["Conv", "LeakyRelu"])
        x = self.input(4, 4)
        np.testing.assert_allclose(run(model, x), expected_convolution(x, self.kernel, self.bias), atol=1e-5)

    def test_the_input_may_get_another_size(self):
        model = convolution_model(self.kernel, self.bias).convert(size=(6, 10))
        x = self.input(6, 10)
        np.testing.assert_allclose(run(model, x), expected_convolution(x, self.kernel, self.bias), atol=1e-5)

    def test_concatenation_and_split_follow_the_layout(self):
        small = SmallModel(
            [node("nhwc", "Transpose", "x", "to_nhwc"),
             node("joined", "ConcatV2", "nhwc", "nhwc", "axis"),
             node("parts", "SplitV", "joined", "sizes", "axis"),
             node("out", "Identity", "parts:1")],
            {"to_nhwc": TO_NHWC, "axis": 3, "sizes": [1, 3]}, "out:0")
        x = self.input(4, 4)
        joined = np.concatenate([x, x], 1).transpose(TO_NHWC)
        np.testing.assert_array_equal(run(small.convert(), x), joined[..., 1:])

    def test_bilinear_resize_has_half_pixel_centres(self):
        small = SmallModel(
            [node("nhwc", "Transpose", "x", "to_nhwc"),
             node("half", "ResizeBilinear", "nhwc", "size", half_pixel_centers={"b": True}, align_corners={"b": False}),
             node("nchw", "Transpose", "half", "to_nchw"),
             node("out", "Identity", "nchw")],
            {"to_nhwc": TO_NHWC, "to_nchw": TO_NCHW, "size": [2, 2]}, "out:0")
        x = self.input(4, 4)
        np.testing.assert_allclose(run(small.convert(), x), x.reshape(1, 2, 2, 2, 2, 2).mean((3, 5)), atol=1e-6)

    def test_the_same_model_gives_the_same_bytes(self):
        model = convolution_model(self.kernel, self.bias)
        self.assertEqual(*(model.convert().SerializeToString(deterministic=True) for _ in range(2)))

    def test_what_it_cannot_convert_is_named(self):
        model = convolution_model(self.kernel, self.bias)
        model.nodes.insert(1, node("odd", "Softplus", "x"))
        with self.assertRaisesRegex(ConversionError, "odd: operator Softplus is not supported"):
            model.convert()

    def test_a_weight_file_that_is_too_short_is_named(self):
        with self.assertRaisesRegex(ConversionError, "weight bias: the weight file ends before it"):
            convolution_model(self.kernel, self.bias).convert(cut=1)

    def test_a_cycle_does_not_hang(self):
        self.assertEqual(len(in_topological_order([node("a", "Add", "b"), node("b", "Add", "a")])), 2)

    def test_a_file_that_is_no_model_ends_with_a_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "m.json"
            for content in ("not JSON", "{}", '{"format": "graph-model"}', '{"format": "graph-model", "modelTopology": 1}'):
                path.write_text(content)
                with self.assertRaisesRegex(SystemExit, "cannot be converted"), contextlib.redirect_stdout(io.StringIO()):
                    sys.argv = ["convert_tfjs.py", str(path), str(path)]
                    convert_tfjs.main()


if __name__ == "__main__":
    unittest.main()
