# SPDX-License-Identifier: Apache-2.0
"""test_summary.py RESULTS.xml NAME: what ctest's JUnit file says, in a few lines.

Every skipped test with its reason, then `NAME: N passed, N failed, N skipped (N: why, N: why)`. Exit status: number of skipped tests, at
most 99.
"""
import collections
import re
import sys
import xml.etree.ElementTree


def reason(case):
    """What the test printed below 'Skipped', or the last line it printed."""
    output = (case.findtext('system-out') or '').strip()
    below = re.search(r': Skipped\n(.+)', output) or re.search(r"\.\.\. skipped '(.+)'", output)
    return below.group(1) if below else (output.splitlines() or ['no reason given'])[-1]


def causes(reasons):
    """How often each cause, what a reason says up to its first comma or colon, the most frequent first."""
    counted = collections.Counter(re.split('[,:]', text)[0] for text in reasons)
    return ', '.join(f'{number}: {cause}' for cause, number in counted.most_common())


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter('testcase'))
    skipped = [c for c in cases if c.find('skipped') is not None or c.get('status') in ('notrun', 'disabled')]
    failed = [c for c in cases if c.get('status') == 'fail']
    for case in skipped:
        print(f"skipped: {case.get('name')}: {reason(case)}")
    why = f' ({causes(map(reason, skipped))})' if skipped else ''
    print(f'{sys.argv[2]}: {len(cases) - len(skipped) - len(failed)} passed, {len(failed)} failed, {len(skipped)} skipped{why}')
    return min(len(skipped), 99)


if __name__ == '__main__':
    sys.exit(main())
