#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pages.py ROOT OUT: the pages of the site, below OUT/pages, and its mkdocs.yml.

They are the tree's own Markdown files in their own folders, with what they link to, so that all links stay as they are; pages of
settings are made from the services' YAML files. docs/topics.md is to be there already.
"""
import pathlib
import re
import shutil
import subprocess
import sys

import settings

SERVICES = ("tracker", "detector", "transformer", "mapper", "loop_closer", "viewer")
LINK = re.compile(r"(\[[^\]]*\]\()([^)#\s]+)((?:#[^)\s]*)?\))")
CODE = re.compile(r"(```.*?```)", re.DOTALL)


def linked_folder(link, page):
    """A link to a folder leads to its README; mkdocs knows no folders."""
    target = page.parent / link
    return link.rstrip("/") + "/README.md" if target.is_dir() and (target / "README.md").is_file() else link


def copy_page(page, root, pages):
    """With what it links to, of this tree."""
    def fixed(match):
        link = match[2] if "://" in match[2] else linked_folder(match[2], page)
        target = (page.parent / link).resolve()
        if "://" not in link and target.is_file() and root in target.parents and target.suffix != ".md":
            copy = pages / target.relative_to(root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(target, copy)
        return match[1] + link + match[3]
    parts = CODE.split(page.read_text(encoding="utf-8"))
    text = "".join(part if part.startswith("```") else LINK.sub(fixed, part) for part in parts)
    for image in re.findall(r'src="([^":]+)"', text):
        shutil.copyfile(page.parent / image, pages / (page.parent / image).resolve().relative_to(root))
    out = pages / page.relative_to(root)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(text, encoding="utf-8")


def title_of(page):
    return page.read_text(encoding="utf-8").splitlines()[0].lstrip("# ")


def main(root, out):
    pages = out / "pages"
    tracked = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=root, check=True,
                             capture_output=True, text=True).stdout.split()
    for name in tracked:
        copy_page(root / name, root, pages)
    (pages / "docs/settings").mkdir(parents=True, exist_ok=True)
    for service in SERVICES:
        yaml = root / f"services/{service}/{service}.yaml"
        (pages / f"docs/settings/{service}.md").write_text(settings.page(service, yaml.read_text(encoding="utf-8")), encoding="utf-8")
        shutil.copyfile(yaml, pages / yaml.relative_to(root))
    decisions = sorted((root / "docs/decisions").glob("*.md"))
    listed = "".join(f"- [{title_of(page)}]({page.name})\n" for page in decisions)
    (pages / "docs/decisions/README.md").write_text("# Decisions\n\nWhat was tried, and why it is as it is.\n\n" + listed, encoding="utf-8")
    nav = {"SETTINGS": [f"docs/settings/{service}.md" for service in SERVICES],
           "DECISIONS": ["docs/decisions/README.md", *(f"docs/decisions/{page.name}" for page in decisions)]}
    config = (root / "tools/docs/mkdocs.yml").read_text(encoding="utf-8")
    for mark, names in nav.items():
        config = config.replace(f" {mark}\n", "\n" + "".join(f"      - {name}\n" for name in names))
    (out / "mkdocs.yml").write_text(config.replace("../../build/docs/", ""), encoding="utf-8")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
