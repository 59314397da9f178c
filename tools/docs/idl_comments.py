#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""idl_comments.py FILE: the IDL with its comments as doxygen reads them.

The text above the include guard is of the struct, what stands behind a member is of the member.
"""
import pathlib
import re
import sys

BEHIND = re.compile(r"^(\s*[^/\s][^/]*?|\s+)//\s*")


def for_doxygen(idl):
    about = []
    for line in idl.splitlines():
        if line.startswith("//"):
            about += [line[2:].strip()] if "SPDX" not in line else []
        elif line.strip().startswith("struct "):
            yield "/** " + " ".join(about) + " */"
            yield line
        else:
            yield BEHIND.sub(lambda found: found[1] + "///< ", line)


if __name__ == "__main__":
    print("\n".join(for_doxygen(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))))
