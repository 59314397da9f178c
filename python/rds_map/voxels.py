# SPDX-License-Identifier: Apache-2.0
import dataclasses

import numpy as np

_FIRST_KEY_OF_POSITIVE = 32768  # OctoMap's keys: the voxel that begins at 0


@dataclasses.dataclass(frozen=True)
class Voxels:
    """All known voxels of one revision of the map, ordered by key. The arrays are never written again: keep them as you like."""

    resolution: float  # edge of a voxel [m]
    map_epoch: int
    map_id: int
    revision: int
    keys: np.ndarray  # N×3 uint16, OctoMap's at the finest level
    log_odds: np.ndarray  # N float32
    colors: np.ndarray  # N×3 uint8, red, green, blue
    labels: np.ndarray  # N uint16, index into label_names
    label_names: tuple = ("",)  # of the map; 0 is "", no object

    def __len__(self):
        return len(self.log_odds)

    @property
    def centers(self):
        """N×3 [m], frame `map`."""
        return (self.keys.astype(np.float64) - _FIRST_KEY_OF_POSITIVE + 0.5) * self.resolution

    @property
    def occupied(self):
        """N bool; the others are free. What is in no row is unknown."""
        return self.log_odds > 0

    @property
    def names(self):
        """N str: the label of each voxel, "" where it is of no object."""
        return np.array(self.label_names)[np.minimum(self.labels, len(self.label_names) - 1)]
