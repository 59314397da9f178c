#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What holds for the tree of sources; run when CMake configures. Prints each violation, then exits with 1.

- The core of a service names no clock, file or thread: it is a function of its inputs.
- Folders include each other without cycles.
- A folder holds at most 25 files.
"""
import pathlib
import re
import sys

MAX_FILES = 25
NOT_OURS = {"__pycache__", "node_modules"}
FORBIDDEN_IN_CORES = re.compile(
    r"\b(steady_clock|system_clock|high_resolution_clock|[io]?fstream|std::filesystem|"
    r"std::(?:jthread|thread|(?:shared_|recursive_)?mutex|condition_variable\w*)\b)")
INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)
COMMENT = re.compile(r"//.*")


def core_violations(sources):
    for path, text in sources.items():
        if not re.match(r"services/[^/]+/core/", path):
            continue
        found = FORBIDDEN_IN_CORES.search(COMMENT.sub("", text))
        if found:
            yield f"{path}: {found[1]}: the core of a service names no clock, file or thread"


def folder_graph(sources):
    graph = {}
    for path, text in sources.items():
        folder = str(pathlib.PurePosixPath(path).parent)
        included = {str(pathlib.PurePosixPath(name).parent) for name in INCLUDE.findall(text) if name in sources}
        graph.setdefault(folder, set()).update(included - {folder})
    return graph


def reachable(graph, start):
    seen, todo = set(), list(graph.get(start, ()))
    while todo:
        folder = todo.pop()
        if folder not in seen:
            seen.add(folder)
            todo.extend(graph.get(folder, ()))
    return seen


def cycle_violations(sources):
    graph = folder_graph(sources)
    for folder in sorted(graph):
        if folder not in reachable(graph, folder):
            continue
        partners = sorted(other for other in graph[folder] if folder in reachable(graph, other))
        yield f"{folder}: includes {', '.join(partners)}, which include it again"


def size_violations(files):
    count = {}
    for path in files:
        folder = str(pathlib.PurePosixPath(path).parent)
        count[folder] = count.get(folder, 0) + 1
    for folder, files_there in sorted(count.items()):
        if files_there > MAX_FILES:
            yield f"{folder}: {files_there} files, at most {MAX_FILES}"


def violations(root):
    files = [
        path.relative_to(root).as_posix() for top in ("common", "services", "tools", "tests")
        for path in (root / top).rglob("*")
        if path.is_file() and not NOT_OURS.intersection(path.parts) and not path.name.startswith(".")
    ]
    sources = {name: (root / name).read_text() for name in files if name.endswith((".cpp", ".hpp"))}
    return [*core_violations(sources), *cycle_violations(sources), *size_violations(files)]


if __name__ == "__main__":
    found = violations(pathlib.Path(sys.argv[1]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
