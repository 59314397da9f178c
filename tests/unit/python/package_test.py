# SPDX-License-Identifier: Apache-2.0
"""What pip installs: the package works without the tree, with the table of colours, and with numpy and cyclonedds alone."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import tree

USE = "import rds_map, rds_map.labels; print(rds_map.__file__, rds_map.labels.label_color('chair'))"


class Package(unittest.TestCase):
    def test_is_whole_outside_the_tree(self):
        with tempfile.TemporaryDirectory() as place:
            source = pathlib.Path(place, "python")
            shutil.copytree(tree.ROOT / "python", source)  # follows the link to labels.yaml, as pip does
            build = [sys.executable, "-c", "import setuptools; setuptools.setup()", "-q", "build", "--build-lib", place + "/lib"]
            subprocess.run(build, cwd=source, check=True, capture_output=True)
            shutil.rmtree(source)
            used = subprocess.run([sys.executable, "-B", "-c", USE], cwd=place + "/lib", check=True, capture_output=True, text=True)
            self.assertEqual(used.stdout.strip(), f"{place}/lib/rds_map/__init__.py (31, 119, 180)")

    def test_messages_are_those_of_the_interface(self):
        from rds_map import messages
        for name in ("MapInfo", "OctreeDelta", "PredictedBoxes", "TrackingState"):
            text = (tree.ROOT / f"idl/rds_msgs/msg/{name}.msg").read_text(encoding="utf-8")
            lines = [line.split("#")[0].split() for line in text.splitlines()]
            fields = [line[1] for line in lines if len(line) == 2 and "=" not in line[1]]
            self.assertEqual(list(getattr(messages, name).__annotations__), fields, name)


if __name__ == "__main__":
    unittest.main()
