# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tiny siamese network of NanoTrack v3's inputs and outputs, with random weights.

It finds what looks like the middle of the template: the backbone is one layer of coarse random
patterns, the head correlates 2 x 2 places of the template with the search crop. Between its
places, 16 px apart, it is often wrong, so that all ways through the fusion are taken.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

CHANNELS = 16
SHARPNESS, EVEN = 2.0, 2.0  # of the classes; a correlation, at most 4, that may be either
SIDES = 32.0  # px of the search crop: distance of a box's sides from its middle


def write_network(folder: Path, seed: int = 1) -> Path:
    """Write ``made_backbone.onnx`` and ``made_head.onnx`` into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(seed)
    onnx.save(_backbone(rng), folder / "made_backbone.onnx")
    onnx.save(_head(rng), folder / "made_head.onnx")
    return folder


def _backbone(rng: np.random.Generator) -> onnx.ModelProto:
    """(1, 3, 255, 255) to (1, 16, 16, 16), and 127 px to 8: unit vectors."""
    coarse = rng.normal(size=(CHANNELS, 3, 3, 3))
    coarse -= coarse.mean(axis=(2, 3), keepdims=True)  # blind to what is even
    weights = coarse.repeat(5, axis=2).repeat(5, axis=3)
    nodes = [
        helper.make_node("Conv", ["input", "weights"], ["patterns"], strides=[16, 16]),
        helper.make_node("LpNormalization", ["patterns"], ["output"], axis=1, p=2),
    ]
    return _model(
        nodes,
        {"input": (1, 3, 255, 255)},
        {"output": (1, CHANNELS, 16, 16)},
        {"weights": weights.astype(np.float32)},
    )


def _head(rng: np.random.Generator) -> onnx.ModelProto:
    """Features (1, 16, 8, 8) and (1, 16, 16, 16) to (1, 2, 15, 15) and (1, 4, 15, 15)."""
    sides = np.log(SIDES * rng.uniform(0.8, 1.25, 4))
    given = {
        "first": np.array([3, 3], np.int64),
        "last": np.array([5, 5], np.int64),
        "axes": np.array([2, 3], np.int64),
        "to_classes": np.array([-SHARPNESS, SHARPNESS], np.float32).reshape(2, 1, 1, 1),
        "even": np.array([SHARPNESS * EVEN, -SHARPNESS * EVEN], np.float32),
        "to_sides": rng.normal(0, 0.1, (4, 1, 1, 1)).astype(np.float32),
        "usual_sides": sides.astype(np.float32),
    }
    nodes = [
        helper.make_node("Slice", ["input1", "first", "last", "axes"], ["kernel"]),
        helper.make_node("Conv", ["input2", "kernel"], ["alike"]),
        helper.make_node("Conv", ["alike", "to_classes", "even"], ["output1"]),
        helper.make_node("Conv", ["alike", "to_sides", "usual_sides"], ["logarithms"]),
        helper.make_node("Exp", ["logarithms"], ["output2"]),
    ]
    return _model(
        nodes,
        {"input1": (1, CHANNELS, 8, 8), "input2": (1, CHANNELS, 16, 16)},
        {"output1": (1, 2, 15, 15), "output2": (1, 4, 15, 15)},
        given,
    )


def _model(
    nodes: list[onnx.NodeProto],
    inputs: dict[str, tuple[int, ...]],
    outputs: dict[str, tuple[int, ...]],
    given: dict[str, np.ndarray],
) -> onnx.ModelProto:
    def shapes(table: dict[str, tuple[int, ...]]) -> list[onnx.ValueInfoProto]:
        return [
            helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)
            for name, shape in table.items()
        ]

    graph = helper.make_graph(
        nodes,
        "made",
        shapes(inputs),
        shapes(outputs),
        [numpy_helper.from_array(values, name) for name, values in given.items()],
    )
    # As old as NanoTrack's files, which every OpenCV that reads those can read.
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 14)], ir_version=7)
    onnx.checker.check_model(model)
    return model
