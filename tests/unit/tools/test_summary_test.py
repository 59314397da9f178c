# SPDX-License-Identifier: Apache-2.0
"""What the last lines of tools/test.sh say about tests that were skipped."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SUMMARY = pathlib.Path(__file__).resolve().parents[3] / "tools" / "test_summary.py"
RESULTS = """<testsuite>
<testcase name="A.Passes" status="run"><system-out>fine</system-out></testcase>
<testcase name="A.Fails" status="fail"><system-out>no</system-out></testcase>
<testcase name="B.Kitchen" status="run"><skipped/><system-out>b.cpp:7: Skipped
RDS_SHARED is not set, so there is no recording kitchen
done</system-out></testcase>
<testcase name="B.Office" status="run"><skipped/><system-out>b.cpp:9: Skipped
RDS_SHARED is not set, so there is no recording office</system-out></testcase>
<testcase name="client_test" status="notrun"><system-out>test_hears (C.test_hears) ... skipped 'no Python package cyclonedds (set RDS_PYTHON)'
OK (skipped=1)</system-out></testcase>
</testsuite>"""


def summary(results):
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(results)
        file.flush()
        return subprocess.run([sys.executable, SUMMARY, file.name, "release"], capture_output=True, text=True, check=False)


class Summary(unittest.TestCase):
    def test_says_why_tests_were_skipped_and_in_the_last_line_how_many_for_which_cause(self):
        said = summary(RESULTS)
        self.assertEqual(said.returncode, 3, said.stderr)
        self.assertEqual(said.stdout.splitlines(), [
            "skipped: B.Kitchen: RDS_SHARED is not set, so there is no recording kitchen",
            "skipped: B.Office: RDS_SHARED is not set, so there is no recording office",
            "skipped: client_test: no Python package cyclonedds (set RDS_PYTHON)",
            "release: 1 passed, 1 failed, 3 skipped (2: RDS_SHARED is not set, 1: no Python package cyclonedds (set RDS_PYTHON))"])

    def test_names_no_cause_where_nothing_was_skipped(self):
        said = summary('<testsuite><testcase name="A" status="run"/></testsuite>')
        self.assertEqual((said.returncode, said.stdout), (0, "release: 1 passed, 0 failed, 0 skipped\n"))


if __name__ == "__main__":
    unittest.main()
