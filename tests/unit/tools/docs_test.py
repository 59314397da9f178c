# SPDX-License-Identifier: Apache-2.0
"""The pages of the site: settings as their YAML says them, messages as their IDL does, dead links found, folders led to their READMEs."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/docs"))
import idl_comments  # noqa: E402
import links  # noqa: E402
import pages  # noqa: E402
import settings  # noqa: E402

YAML = """# Settings.
nice: 10          # 0 to 19: gives way
name: ""          # empty: none
grid:             # 2-D projection
  up: auto        # or x|y
  deep:
    est: [1, 2]
objects: {a: 1}
"""


class Docs(unittest.TestCase):
    def test_settings_have_their_sections_defaults_and_words(self):
        self.assertEqual(list(settings.rows(YAML)), [
            ("nice", "10", "0 to 19: gives way"), ("name", '""', "empty: none"), ("grid", "", "2-D projection"),
            ("grid.up", "auto", "or x|y"), ("grid.deep", "", ""), ("grid.deep.est", "[1, 2]", ""), ("objects", "{a: 1}", "")])
        self.assertIn("| `grid.up` | `auto` | or x\\|y |", settings.page("mapper", YAML))

    def test_every_key_of_the_shipped_settings_is_on_its_page(self):
        for service in pages.SERVICES:
            yaml = (ROOT / f"services/{service}/{service}.yaml").read_text(encoding="utf-8")
            keys = [line for line in yaml.splitlines() if line.strip() and not line.lstrip().startswith(("#", "-"))]
            self.assertEqual(len(list(settings.rows(yaml))), len(keys), service)

    def test_what_an_idl_says_of_a_message_and_its_members_reaches_doxygen(self):
        idl = ["// SPDX-License-Identifier: Apache-2.0", "// What it is,", "// and what not.", "#ifndef X", "struct X {",
               "  uint64 n;  // [m]", "             // and more", "};"]
        self.assertEqual(list(idl_comments.for_doxygen("\n".join(idl))), [
            "#ifndef X", "/** What it is, and what not. */", "struct X {", "  uint64 n;  ///< [m]", "             ///< and more", "};"])

    def test_links_that_lead_nowhere_are_found(self):
        with tempfile.TemporaryDirectory() as place:
            site = pathlib.Path(place)
            (site / "a.html").write_text('<a href="b.html#there">1</a><a href="b.html#gone">2</a><img src="no.png">'
                                         '<a href="https://example.org/x">3</a><a href="#mine" id="mine">4</a>')
            (site / "b.html").write_text('<h1 id="there">b</h1>')
            self.assertEqual(list(links.dead_links(site)), ["a.html: b.html#gone", "a.html: no.png"])

    def test_a_link_to_a_folder_leads_to_its_readme(self):
        page = ROOT / "docs/choosing-a-bus.md"
        self.assertEqual(pages.linked_folder("../common/bus", page), "../common/bus/README.md")
        self.assertEqual(pages.linked_folder("decisions", page), "decisions")


if __name__ == "__main__":
    unittest.main()
