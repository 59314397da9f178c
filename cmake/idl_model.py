# SPDX-License-Identifier: Apache-2.0
"""Reads the IDL this project writes: one struct per file, the constants of `module <Struct>_Constants`, no keys,
unions, enums or typedefs; and computes the hash ROS 2 gives a type (REP-2011, RIHS01).

A service is two structs in `module srv`, `<Service>_Request` and `<Service>_Response`; each has a hash of its own, as its endpoints announce it."""

import dataclasses
import hashlib
import json
import pathlib
import re

# IDL name: (name in a .msg file, type id of type_description_interfaces/FieldType, bytes on the wire)
PRIMITIVES = {
    "int8": ("int8", 2, 1), "uint8": ("uint8", 3, 1), "int16": ("int16", 4, 2), "uint16": ("uint16", 5, 2),
    "int32": ("int32", 6, 4), "uint32": ("uint32", 7, 4), "int64": ("int64", 8, 8), "uint64": ("uint64", 9, 8),
    "float": ("float32", 10, 4), "double": ("float64", 11, 8), "boolean": ("bool", 15, 1), "char": ("char", 13, 1), "octet": ("byte", 16, 1),
}
STRING, BOUNDED_STRING, NESTED = 17, 21, 1
ARRAY_OFFSET, BOUNDED_SEQUENCE_OFFSET, UNBOUNDED_SEQUENCE_OFFSET = 48, 96, 144


def kind_of(struct_name):
    """The module that a struct is in."""
    return "srv" if struct_name.endswith(("_Request", "_Response")) else "msg"


@dataclasses.dataclass(frozen=True)
class Field:
    name: str
    type: str  # key of PRIMITIVES, "string", or the ROS name of a struct ("std_msgs/msg/Header")
    array: int = 0  # > 0: fixed-size array
    sequence: bool = False
    string_bound: int = 0  # > 0: string<bound>
    sequence_bound: int = 0  # > 0: sequence<type, bound>

    @property
    def nested(self):
        return "/" in self.type


@dataclasses.dataclass(frozen=True)
class Struct:
    package: str
    name: str
    fields: tuple
    constants: tuple  # (IDL type, name, value)

    @property
    def kind(self):
        return kind_of(self.name)

    @property
    def ros_name(self):
        return f"{self.package}/{self.kind}/{self.name}"

    @property
    def dds_name(self):
        return f"{self.package}::{self.kind}::dds_::{self.name}_"

    @property
    def cpp_name(self):
        return f"{self.package}::{self.kind}::{self.name}"

    @property
    def header(self):
        return f"{self.ros_name}.h"


_IDL_FILE = re.compile(
    r"module (?P<package>\w+) \{ module (?P<kind>msg|srv) \{ "
    r"(?:module (?P<owner>\w+)_Constants \{ (?P<constants>(?:const [^;]+; )*)\}; )?"
    r"struct (?P<name>\w+) \{ (?P<fields>(?:[^;{}]+; )+)\}; \}; \};")
# A name that is a word of IDL is written with an underscore before it.
_FIELD = re.compile(r"(?:sequence<(?P<element>[\w:]+)(?:, (?P<most>\d+))?>|string<(?P<bound>\d+)>|(?P<plain>[\w:]+))"
                    r" _?(?P<name>[a-z]\w*)(?:\[(?P<array>\d+)\])?")
_CONSTANT = re.compile(r"const (\w+) ([A-Z][A-Z0-9_]*) = (-?\d+)")


def _type_name(idl_name, path):
    if idl_name in PRIMITIVES or idl_name == "string":
        return idl_name
    if re.fullmatch(r"\w+::msg::\w+", idl_name):
        return idl_name.replace("::", "/")
    raise ValueError(f"{path}: '{idl_name}' is not a primitive of the restricted IDL and not pkg::msg::Name")


def _parse_field(text, path):
    match = _FIELD.fullmatch(text)
    if not match:
        raise ValueError(f"{path}: cannot read the member '{text}'")
    element = match["element"] or ("string" if match["bound"] else match["plain"])
    return Field(match["name"], _type_name(element, path), int(match["array"] or 0), bool(match["element"]),
                 int(match["bound"] or 0), int(match["most"] or 0))


def parse_idl(path):
    """The struct in an IDL file. Raises ValueError naming the file for anything outside the restricted IDL."""
    text = re.sub(r"//[^\n]*|^\s*#[^\n]*", "", pathlib.Path(path).read_text(encoding="utf-8"), flags=re.M)
    match = _IDL_FILE.fullmatch(" ".join(text.split()))
    if not match:
        raise ValueError(f"{path}: expected 'module <package> {{ module msg {{ [constants] struct <Name> {{ … }}; }}; }};'")
    if match["owner"] not in (None, match["name"]) or match["name"] != pathlib.Path(path).stem:
        raise ValueError(f"{path}: file, struct and constants module must have one name")
    if match["kind"] != kind_of(match["name"]):
        raise ValueError(f"{path}: expected module {kind_of(match['name'])} around {match['name']}")
    fields = tuple(_parse_field(f.strip(), path) for f in match["fields"].split(";") if f.strip())
    return Struct(match["package"], match["name"], fields, tuple(_CONSTANT.findall(match["constants"] or "")))


def load(roots):
    """All structs below the folders: {ROS name: Struct}, every struct after those it contains."""
    parsed = {}
    for root in roots:
        for path in sorted(pathlib.Path(root).glob("*/*.idl")):
            struct = parse_idl(path)
            parsed[struct.ros_name] = struct
    ordered = {}

    def add(name, user):
        if name not in parsed:
            raise ValueError(f"{user} contains {name}, which no IDL file defines")
        for field in parsed[name].fields:
            if field.nested and field.type not in ordered:
                add(field.type, name)
        ordered[name] = parsed[name]

    for name in parsed:
        add(name, name)
    return ordered


def _field_description(field):
    if field.nested:
        type_id = NESTED
    elif field.type == "string":
        type_id = BOUNDED_STRING if field.string_bound else STRING
    else:
        type_id = PRIMITIVES[field.type][1]
    if field.array:
        type_id += ARRAY_OFFSET
    elif field.sequence:
        type_id += BOUNDED_SEQUENCE_OFFSET if field.sequence_bound else UNBOUNDED_SEQUENCE_OFFSET
    return {"name": field.name, "type": {"type_id": type_id, "capacity": field.array or field.sequence_bound, "string_capacity": field.string_bound,
                                         "nested_type_name": field.type if field.nested else ""}}


def _description(struct):
    return {"type_name": struct.ros_name, "fields": [_field_description(f) for f in struct.fields]}


def _referenced(struct, structs):
    names = set()
    for field in struct.fields:
        if field.nested:
            names |= {field.type} | _referenced(structs[field.type], structs)
    return names


def type_hash(struct, structs):
    """RIHS01_<sha256 of the type description as JSON>; constants and defaults do not count."""
    description = {"type_description": _description(struct),
                   "referenced_type_descriptions": [_description(structs[n]) for n in sorted(_referenced(struct, structs))]}
    return "RIHS01_" + hashlib.sha256(json.dumps(description, ensure_ascii=True).encode()).hexdigest()


# What ROS 2 puts into every service for those who watch its requests (service_msgs). Nobody here sends it; the services' hashes cover it.
_EVENT_INFO = Struct("service_msgs", "ServiceEventInfo", (
    Field("event_type", "uint8"), Field("stamp", "builtin_interfaces/msg/Time"), Field("client_gid", "uint8", array=16),
    Field("sequence_number", "int64")), ())


@dataclasses.dataclass(frozen=True)
class _PartOfService(Struct):
    """A struct in `module srv` that is neither request nor response."""

    @property
    def kind(self):
        return "srv"


def service_hash(request, structs):
    """The hash of the service that this request belongs to, as type_hash()."""
    name = request.name.removesuffix("_Request")
    part = f"{request.package}/srv/{name}"
    event = _PartOfService(request.package, name + "_Event", (
        Field("info", _EVENT_INFO.ros_name), Field("request", part + "_Request", sequence=True, sequence_bound=1),
        Field("response", part + "_Response", sequence=True, sequence_bound=1)), ())
    service = _PartOfService(request.package, name, (
        Field("request_message", part + "_Request"), Field("response_message", part + "_Response"), Field("event_message", event.ros_name)), ())
    return type_hash(service, structs | {_EVENT_INFO.ros_name: _EVENT_INFO, event.ros_name: event})


def msg_lines(struct):
    """The struct as the lines of its .msg file, without comments and blank lines."""
    def ros_type(field):
        base = PRIMITIVES[field.type][0] if field.type in PRIMITIVES else field.type.replace("/msg/", "/")
        bound = f"<={field.string_bound}" if field.string_bound else ""
        most = f"<={field.sequence_bound}" if field.sequence_bound else ""
        return base + bound + (f"[{field.array}]" if field.array else f"[{most}]" if field.sequence else "")
    return ([f"{PRIMITIVES[t][0]} {name}={value}" for t, name, value in struct.constants] +
            [f"{ros_type(f)} {f.name}" for f in struct.fields])


def definition(struct, structs):
    """The struct as ROS 2 writes it into recordings (encoding ros2msg): its .msg lines, then those of all that it contains."""
    def block(name):
        return "=" * 80 + f"\nMSG: {name.replace('/msg/', '/')}\n" + "\n".join(msg_lines(structs[name])) + "\n"
    return "\n".join(msg_lines(struct)) + "\n" + "".join(block(name) for name in sorted(_referenced(struct, structs)))
