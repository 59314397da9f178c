#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""links.py SITE: prints every link of the site's pages that leads nowhere in it, also into a page; then exits with 1.

mkdocs looks at files alone, not at the places within them."""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.places, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.places.update(found[name] for name in ("id", "name") if name in found)
        self.links += [found[name] for name in ("href", "src") if found.get(name)]


def dead_links(site):
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    for path, page in sorted(pages.items()):
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc or path.name == "404.html":
                continue
            target = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
            if target.is_dir():
                target /= "index.html"
            place = urllib.parse.unquote(url.fragment)
            if not target.is_file() or (place and target in pages and not place.startswith("__") and place not in pages[target].places):
                yield f"{path.relative_to(site)}: {link}"


if __name__ == "__main__":
    found = list(dead_links(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(found))
    sys.exit(1 if found else 0)
