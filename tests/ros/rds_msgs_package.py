# SPDX-License-Identifier: Apache-2.0
"""rds_msgs_package.py SOURCE TARGET: makes a ROS 2 package of SOURCE/msg/*.msg and SOURCE/srv/*.srv in TARGET, as colcon would, with the generators of ROS 2's own wheels.

Run with the interpreter of .venv-jazzy or .venv-kilted. TARGET/rds_msgs is the Python package, TARGET/idl/rds_msgs/{msg,srv}/TYPE.json has the hash of a type; the libraries have to be in
LD_LIBRARY_PATH. TARGET/ros_messages is ros_messages.cpp with the C++ types.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

PREFIX = pathlib.Path(sys.prefix)
os.environ["AMENT_PREFIX_PATH"] = str(PREFIX)
import numpy  # noqa: E402
from rosidl_adapter.msg import convert_msg_to_idl  # noqa: E402
from rosidl_adapter.srv import convert_srv_to_idl  # noqa: E402
from rosidl_generator_c.cli import GenerateC  # noqa: E402
from rosidl_generator_cpp.cli import GenerateCpp  # noqa: E402
from rosidl_generator_py.cli import GeneratePython  # noqa: E402
from rosidl_generator_type_description.cli import HashTypeDescription  # noqa: E402
from rosidl_typesupport_c.cli import GenerateCTypesupport  # noqa: E402
from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport  # noqa: E402
from rosidl_typesupport_fastrtps_cpp.cli import GenerateFastRTPSCppTypesupport  # noqa: E402
from rosidl_typesupport_introspection_c.cli import GenerateIntrospectionCTypesupport  # noqa: E402

NAME = "rds_msgs"
SUPPORTS = ["typesupport_fastrtps_c", "typesupport_introspection_c"]  # that rmw_fastrtps asks for
GENERATORS = {"generator_c": GenerateC(""), "generator_cpp": GenerateCpp(""), "typesupport_fastrtps_c": GenerateFastRTPSCTypesupport(""),
              "typesupport_introspection_c": GenerateIntrospectionCTypesupport(""), "typesupport_fastrtps_cpp": GenerateFastRTPSCppTypesupport(""),
              "typesupport_c": GenerateCTypesupport("", typesupport_implementations=[f"rosidl_{support}" for support in SUPPORTS]),
              "generator_py": GeneratePython("", typesupport_implementations=["rosidl_typesupport_c"])}


def generate(source, target):
    """TARGET/GENERATOR/rds_msgs is what each generator makes, but Python's."""
    idl = target / "idl" / NAME
    for kind, convert in (("msg", convert_msg_to_idl), ("srv", convert_srv_to_idl)):
        (idl / kind).mkdir(parents=True)
        for file in sorted((source / kind).glob(f"*.{kind}")):
            convert(source, NAME, file.relative_to(source), idl / kind)
    given = {"package_name": NAME, "interface_files": [f"{idl}:{file.relative_to(idl)}" for file in sorted(idl.glob("*/*.idl"))],
             "include_paths": [str(PREFIX / "share"), str(idl.parent)]}
    hashes = HashTypeDescription("").generate_type_hashes(**given, output_path=idl)
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        made = [pool.submit(run_generator, name, target, given, hashes) for name in GENERATORS]
        for one in made:
            one.result()


def run_generator(name, target, given, hashes):
    folder = target / ("" if name == "generator_py" else name) / NAME
    GENERATORS[name].generate(**given, output_path=folder, **({"type_description_files": hashes} if name in ("generator_c", "generator_cpp") else {}))


def write_lines(target, form, values):
    target.write_text("".join(form.format(value) + "\n" for value in values), encoding="utf-8")
    return target


def sources_of(target):
    """By generator. All C++ of one is one source: each file alone would read the same headers for seconds."""
    sources = {name: sorted((target / name).glob("**/*.c")) for name in GENERATORS} | {"generator_py": sorted((target / NAME).glob("**/*.c"))}
    for name in ("typesupport_c", "typesupport_fastrtps_c", "typesupport_fastrtps_cpp"):
        sources[name] = [write_lines(target / f"{name}.cpp", '#include "{}"', sorted((target / name).glob("**/*.cpp")))]
    write_lines(target / "messages.inc", "MESSAGE({})", [file.stem for file in sorted((target / "idl" / NAME / "msg").glob("*.idl"))])
    headers = [file for name in ("generator_cpp", "typesupport_fastrtps_cpp") for file in sorted((target / name).glob("**/*.hpp"))]
    write_lines(target / "headers.inc", '#include "{}"', headers)
    sources["ros_messages"] = [pathlib.Path(__file__).with_name("ros_messages.cpp")]
    return sources


def compile_one(source, target):
    """By ccache where there is one, to which the generated files are the same in any folder and new ones are no riddle."""
    includes = [target, *(target / name for name in GENERATORS), PREFIX / "include", *(PREFIX / "include").iterdir(), sysconfig.get_path("include"), numpy.get_include()]
    made = target / "objects" / (str(source).replace("/", "_") + ".o")
    cached = ["ccache"] if shutil.which("ccache") else []
    dialect = ["-std=c++17"] if source.suffix == ".cpp" else []
    subprocess.run([*cached, "gcc", "-c", "-fPIC", "-w", *dialect, *(f"-I{folder}" for folder in includes), source, "-o", made], check=True, cwd=target,
                   env=os.environ | {"CCACHE_BASEDIR": str(target), "CCACHE_SLOPPINESS": "include_file_ctime,include_file_mtime"})
    return made


def link(made, objects, *options):
    libraries = [f"{package}__rosidl_{part}" for package in ("std_msgs", "geometry_msgs", "builtin_interfaces", "sensor_msgs", "service_msgs") for part in GENERATORS
                 if part != "generator_cpp"]  # of headers alone
    libraries += ["rosidl_runtime_c", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp", "rosidl_typesupport_introspection_c",
                  "fastcdr", "rcutils"]
    subprocess.run(["g++", *options, *objects, "-o", made, f"-L{PREFIX / 'lib'}", f"-Wl,-rpath-link,{PREFIX / 'lib'}", *(f"-l{library}" for library in libraries)],
                   check=True)
    return made


def build(target):
    """A library per type support, which ROS finds by its name, the extension module, and the program with the C++ types."""
    (target / "objects").mkdir()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        made = {name: [pool.submit(compile_one, file, target) for file in files] for name, files in sources_of(target).items()}
        objects = {name: [one.result() for one in those] for name, those in made.items()}
    base = link(target / f"lib{NAME}__rosidl_generator_c.so", objects["generator_c"] + objects["typesupport_c"], "-shared")
    for name in SUPPORTS:
        link(target / f"lib{NAME}__rosidl_{name}.so", [*objects[name], base], "-shared")
    module = f"{NAME}_s__rosidl_typesupport_c{sysconfig.get_config_var('EXT_SUFFIX')}"
    link(target / NAME / module, [*objects["generator_py"], base], "-shared")
    link(target / "ros_messages", [*objects["ros_messages"], *objects["typesupport_fastrtps_cpp"], base])


def main():
    source, target = (pathlib.Path(argument).absolute() for argument in sys.argv[1:])
    generate(source, target)
    build(target)


if __name__ == "__main__":
    main()
