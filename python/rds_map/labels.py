# SPDX-License-Identifier: Apache-2.0
"""Labels of a full map, by the colours of its voxels: octomap_msgs has no place for them."""

import functools
import importlib.resources
import math
import re

import numpy as np

MOST_LABELS = 4096
NO_COLOR = (255, 255, 255)


@functools.cache
def _table():
    """Colours of common/labels/labels.yaml, by name and alias. Only its lines `name: {..., color: [r, g, b]}` matter here."""
    text = (importlib.resources.files("rds_map") / "labels.yaml").read_text(encoding="utf-8")
    table = {}
    for name, fields in re.findall(r"^  ([\w ]+): \{(.*)\}$", text, re.MULTILINE):
        color = re.search(r"color: \[(\d+), (\d+), (\d+)\]", fields)
        aliases = re.search(r"aliases: \[([^]]*)\]", fields)
        if color:
            for spelling in [name, *(aliases[1].split(", ") if aliases else [])]:
                table[spelling] = tuple(map(int, color.groups()))
    return table


def label_color(label):
    """Colour (r, g, b) that stands for a label in every map: from the table, else by a hash of the name (FNV-1a), as
    services/mapper/core/octree/label_table.cpp has it."""
    if not label:
        return NO_COLOR
    if label in _table():
        return _table()[label]
    code = 2166136261
    for byte in label.encode():
        code = (code ^ byte) * 16777619 & 0xFFFFFFFF
    hue = code % 97 / 97
    lightness = 0.75 + 0.25 * ((code >> 8 & 255) / 255)

    def channel(shift):
        wave = 0.5 + 0.5 * math.cos(2 * 3.14159265358979 * (hue - shift))
        return math.floor(255 * (0.15 + 0.8 * wave * lightness) + 0.5)
    return channel(0), channel(1 / 3), channel(2 / 3)


def packed_colors(colors):
    return colors.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)


def labels_of_colors(colors, labels):
    """@param colors  N×3. @param labels  label table; index 0 is "".

    @return N indices into the table: of labels with one colour the first; 0 where the colour is none's.
    """
    index_of = {}
    for index, label in list(enumerate(labels))[1:MOST_LABELS]:
        index_of.setdefault(label_color(label), index)
    if not index_of:
        return np.zeros(len(colors), np.uint16)
    known = packed_colors(np.array(list(index_of)))
    order = np.argsort(known)
    indices = np.array(list(index_of.values()), np.uint16)[order]
    known = known[order]
    packed = packed_colors(colors)
    place = np.minimum(np.searchsorted(known, packed), len(known) - 1)
    return np.where(known[place] == packed, indices[place], np.uint16(0))
