#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "cmake"))
import check_structure


class Structure(unittest.TestCase):
    def violations_of(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return check_structure.violations(pathlib.Path(folder))

    def test_this_tree_has_no_violation(self):
        self.assertEqual(check_structure.violations(ROOT), [])

    def test_a_core_that_names_a_clock_is_told(self):
        found = self.violations_of({"services/x/core/a.cpp": "auto t = std::chrono::steady_clock::now();"})
        self.assertEqual(len(found), 1)
        self.assertIn("steady_clock", found[0])

    def test_comments_and_services_may_name_threads(self):
        self.assertEqual(self.violations_of({"services/x/core/a.cpp": "// no std::mutex here",
                                             "services/x/a.cpp": "std::mutex m;"}), [])

    def test_folders_that_include_each_other_are_told(self):
        found = self.violations_of({"common/a/a.hpp": '#include "common/b/b.hpp"\n',
                                    "common/b/b.hpp": '#include "common/c/c.hpp"\n',
                                    "common/c/c.hpp": '#include "common/a/a.hpp"\n'})
        self.assertEqual(len(found), 3)

    def test_a_crowded_folder_is_told(self):
        self.assertEqual(len(self.violations_of({f"common/a/{i}.hpp": "" for i in range(26)})), 1)
        self.assertEqual(self.violations_of({f"common/a/{i}.hpp": "" for i in range(25)}), [])


if __name__ == "__main__":
    unittest.main()
