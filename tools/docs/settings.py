# SPDX-License-Identifier: Apache-2.0
"""Pages of settings, made from the YAML files that ship with the services: keys, defaults, and what their comments say."""
import re

LINE = re.compile(r"^(?P<indent> *)(?P<key>[\w/]+):(?: (?P<value>.*?))?(?:\s+# (?P<text>.*))?$")


def escaped(text):
    return text.replace("|", "\\|").replace("<", "&lt;")


def rows(yaml):
    """(key with its sections, default, text) of each line with a key; a section has no default."""
    above = []  # (indent, key)
    for line in yaml.splitlines():
        found = LINE.match(line)
        if not found:
            continue
        indent = len(found["indent"])
        above = [(depth, key) for depth, key in above if depth < indent]
        name = ".".join([key for _, key in above] + [found["key"]])
        value = (found["value"] or "").strip()
        if value.startswith("#"):  # a section with a comment alone
            value, text = "", value[1:].strip()
        else:
            text = found["text"] or ""
        if not value:
            above.append((indent, found["key"]))
        yield name, value, text


def page(service, yaml):
    lines = [f"# Settings of rds-{service.replace('_', '-')}", "",
             f"What is absent has the default shown here: [{service}.yaml](../../services/{service}/{service}.yaml). "
             "A key that is wrong or out of range is refused with a sentence.", "",
             "| key | default | |", "|---|---|---|"]
    for name, value, text in rows(yaml):
        lines.append(f"| `{name}` | {'`' + value + '`' if value else ''} | {escaped(text)} |")
    return "\n".join(lines) + "\n"
