# SPDX-License-Identifier: Apache-2.0
"""Generates the C++ types of one IDL package with fastddsgen:

    idl_fastddsgen.py --fastddsgen EXE --root DIR... --scratch DIR --out DIR FILE.idl...

writes OUT/<package>/msg/<Name>.h and .cxx, of a service's structs OUT/<package>/srv/<Name>.h and .cxx. fastddsgen 2.3.0 generates every included file again into one flat folder
and puts Java object hashes into comments; so each package has a scratch folder of its own, only its own files are kept,
include lines get their package back and the hashes go: the same IDL gives the same bytes. Bounded strings and sequences become plain
ones (the decoder checks the bound), so that the types need nothing but Fast CDR.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

import idl_model


def copy_without_bounds(roots, target):
    """Copies the IDL trees below target with string<N> written as string, sequence<T, N> as sequence<T>."""
    for root in roots:
        for path in pathlib.Path(root).glob("*/*.idl"):
            copy = target / path.parent.name / path.name
            copy.parent.mkdir(parents=True, exist_ok=True)
            text = re.sub(r"string<\d+>", "string", path.read_text(encoding="utf-8"))
            copy.write_text(re.sub(r"(sequence<[\w:]+), \d+>", r"\1>", text), encoding="utf-8")


def clean(text, packages):
    """Generated text with stable comments and with include lines that say `<package>/msg/<Name>.h`.

    packages: of each name.
    """
    text = re.sub(r"(typecode\.\w+)@[0-9a-f]+", r"\1", text)
    text = re.sub(r'#include <fastrtps/utils/fixed_size_string.hpp>', "#include <cstring>", text)
    return re.sub(r'#include "(?:\w+/)?(\w+)\.h"', lambda m: f'#include "{packages[m[1]]}/{idl_model.kind_of(m[1])}/{m[1]}.h"', text)


def write_if_different(path, text):
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--fastddsgen", required=True)
    parser.add_argument("--root", action="append", required=True)
    parser.add_argument("--scratch", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    args = parser.parse_args()

    shutil.rmtree(args.scratch, ignore_errors=True)
    idl, generated = args.scratch / "idl", args.scratch / "generated"
    copy_without_bounds(args.root, idl)
    generated.mkdir(parents=True)
    files = [str(idl / f.parent.name / f.name) for f in args.files]
    result = subprocess.run([args.fastddsgen, "-replace", "-cs", "-t", str(args.scratch), "-I", str(idl), "-d", str(generated), *files],
                            capture_output=True, text=True, check=False)
    if result.returncode != 0 or "error:" in result.stdout + result.stderr:
        sys.exit(f"fastddsgen failed for {' '.join(files)}:\n{result.stdout}{result.stderr}")

    packages = {p.stem: p.parent.name for p in idl.glob("*/*.idl")}
    for file in args.files:
        folder = args.out / file.parent.name / idl_model.kind_of(file.stem)
        folder.mkdir(parents=True, exist_ok=True)
        for suffix in (".h", ".cxx"):
            text = (generated / (file.stem + suffix)).read_text(encoding="utf-8")
            write_if_different(folder / (file.stem + suffix), clean(text, packages))


if __name__ == "__main__":
    main()
