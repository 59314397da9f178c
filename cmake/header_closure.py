#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""header_closure.py ROOT HEADER...: these headers of the tree and all of the tree that they include, a line each."""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)


def closure(root, headers):
    seen, todo = set(), list(headers)
    while todo:
        header = todo.pop()
        if header not in seen and (root / header).is_file():
            seen.add(header)
            todo.extend(INCLUDE.findall((root / header).read_text()))
    return sorted(seen)


if __name__ == "__main__":
    print("\n".join(closure(pathlib.Path(sys.argv[1]), sys.argv[2:])))
