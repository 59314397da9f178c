# SPDX-License-Identifier: Apache-2.0
"""test_summary.py RESULTS.xml NAME: what ctest's JUnit file says, in a few lines.

Every skipped test with its reason, then `NAME: N passed, N failed, N skipped`. Exit status: number of skipped tests, at most 99.
"""
import re
import sys
import xml.etree.ElementTree


def reason(case):
    """What the test printed below 'Skipped', or the last line it printed."""
    output = (case.findtext('system-out') or '').strip()
    below = re.search(r': Skipped\n(.+)', output)
    return below.group(1) if below else (output.splitlines() or ['no reason given'])[-1]


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter('testcase'))
    skipped = [c for c in cases if c.find('skipped') is not None or c.get('status') in ('notrun', 'disabled')]
    failed = [c for c in cases if c.get('status') == 'fail']
    for case in skipped:
        print(f"skipped: {case.get('name')}: {reason(case)}")
    print(f'{sys.argv[2]}: {len(cases) - len(skipped) - len(failed)} passed, {len(failed)} failed, {len(skipped)} skipped')
    return min(len(skipped), 99)


if __name__ == '__main__':
    sys.exit(main())
