#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Converts a TensorFlow.js graph model of a convolutional detector to ONNX.

    convert_tfjs.py MODEL.json OUT.onnx [--height PIXELS --width PIXELS]

MODEL.json stands beside the weight files that it names. Written for networks that were once converted from ONNX to
TensorFlow: every convolution stands between two transpositions (NCHW to NHWC and back), and shapes of Reshape nodes are
computed from constants. Transpositions are carried along as a permutation instead of being written, paddings are
folded into the convolution or pooling behind them, additions of a constant into the convolution before them.
Such a network takes inputs of any size that its strides divide; --height and --width choose another than the model's.
Weights become float32, whatever they are stored as. The same input gives the same bytes.

Outputs are called output_0, output_1, … in the order of their TensorFlow names.
Needs the Python packages numpy and onnx.
"""
import argparse
import collections
import json
import pathlib
import sys

from tfjs_model import ConversionError, in_topological_order, read_weights
from tfjs_to_onnx import Converter


def convert_model(model_path, size):
    model = json.loads(model_path.read_text())
    if model.get("format") != "graph-model":
        raise ConversionError(f"{model_path}: expected a TensorFlow.js graph model")
    nodes = model["modelTopology"]["node"]
    readers = collections.Counter(name for node in nodes for name in node.get("input", []))
    converter = Converter(read_weights(model_path, model["weightsManifest"]), readers)
    for node in in_topological_order(nodes):
        if node["op"] != "Const":
            converter.convert(node)
    return converter.finish(sorted(model["signature"]["outputs"]), size)


def main():
    parser = argparse.ArgumentParser(description="Converts a TensorFlow.js graph model to ONNX")
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--height", type=int, help="of the input, default: the model's")
    parser.add_argument("--width", type=int)
    arguments = parser.parse_args()
    try:
        model = convert_model(arguments.model, (arguments.height, arguments.width))
    except (ConversionError, OSError, ValueError) as error:
        sys.exit(f"{arguments.model}: cannot be converted: {error}")
    except (AttributeError, IndexError, KeyError, TypeError) as error:
        sys.exit(f"{arguments.model}: cannot be converted: not the fields of a graph model ({error!r})")
    arguments.out.write_bytes(model.SerializeToString(deterministic=True))
    print(f"{arguments.out}: {len(model.graph.node)} nodes")


if __name__ == "__main__":
    main()
