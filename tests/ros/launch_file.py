# SPDX-License-Identifier: Apache-2.0
"""The commands that launch_ros starts for a launch file in XML: of `arg`, `node` and `param`, with `$(var NAME)`; anything else is an error."""

import json
import pathlib
import re
import xml.etree.ElementTree

KNOWN = {"arg": {"name", "default", "description"}, "node": {"pkg", "exec", "name", "namespace", "args", "respawn"}, "param": {"name", "value"}}


def check(element):
    if set(element.attrib) - KNOWN[element.tag]:
        raise ValueError(f"{element.tag}: {sorted(element.attrib)}")
    return element


def typed(text):
    """As YAML would read it: launch_xml gives parameters the type that their text has."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def commands(launch_file, prefix, folder, **given):
    """One list of arguments per node, as launch_ros makes it; parameters are written to files in `folder`.

    prefix: of pkg, as the ament index has it. given: values of arguments.
    """
    root = xml.etree.ElementTree.parse(launch_file).getroot()
    values = {check(a).attrib["name"]: given.get(a.attrib["name"], a.attrib.get("default")) for a in root.iter("arg")}
    if set(given) - set(values):
        raise ValueError(f"no such argument: {sorted(set(given) - set(values))}")

    def text_of(element, attribute):
        return re.sub(r"\$\(var (\w+)\)", lambda m: values[m[1]], element.attrib.get(attribute, ""))

    made = []
    for node in root.findall("node"):
        name, namespace = text_of(check(node), "name"), text_of(node, "namespace")
        parameters = {check(p).attrib["name"]: typed(text_of(p, "value")) for p in node.findall("param")}
        file = pathlib.Path(folder) / f"{name}.yaml"
        file.write_text(json.dumps({"/**": {"ros__parameters": parameters}}), encoding="utf-8")  # JSON is YAML
        names = ["-r", f"__node:={name}"] + (["-r", f"__ns:=/{namespace}"] if namespace else [])
        made.append([str(pathlib.Path(prefix(node.attrib["pkg"])) / "lib" / node.attrib["pkg"] / node.attrib["exec"]), *text_of(node, "args").split(),
                     "--ros-args", *names, "--params-file", str(file)])
    return made
