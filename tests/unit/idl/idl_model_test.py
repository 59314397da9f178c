# SPDX-License-Identifier: Apache-2.0
"""The IDL files: equal to their .msg files, and of the type hashes that ROS 2 computes."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "cmake"))
import idl_model  # noqa: E402

STRUCTS = idl_model.load([ROOT / "idl" / "ros2", ROOT / "idl"])


def parse(text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "Name.idl"
        path.write_text(text, encoding="utf-8")
        return idl_model.parse_idl(path)


def lines_of(file):
    """Without comments and blank lines."""
    lines = (line.partition("#")[0].strip() for line in file.read_text(encoding="utf-8").splitlines())
    return [line for line in lines if line]


class MsgFiles(unittest.TestCase):
    def test_every_rds_msgs_idl_says_what_its_msg_file_says(self):
        files = sorted((ROOT / "idl" / "rds_msgs" / "msg").glob("*.msg"))
        self.assertEqual({f.stem for f in files}, {s.name for s in STRUCTS.values() if s.package == "rds_msgs" and s.kind == "msg"})
        for file in files:
            with self.subTest(file.name):
                self.assertEqual(lines_of(file), idl_model.msg_lines(STRUCTS[f"rds_msgs/msg/{file.stem}"]))

    def test_every_service_says_what_its_srv_file_says(self):
        files = sorted((ROOT / "idl" / "rds_msgs" / "srv").glob("*.srv"))
        parts = {f.stem + part for f in files for part in ("_Request", "_Response")}
        self.assertEqual(parts, {s.name for s in STRUCTS.values() if s.package == "rds_msgs" and s.kind == "srv"})
        for file in files:
            request, response = (STRUCTS[f"rds_msgs/srv/{file.stem}{part}"] for part in ("_Request", "_Response"))
            with self.subTest(file.name):
                self.assertEqual(lines_of(file), [*idl_model.msg_lines(request), "---", *idl_model.msg_lines(response)])


class TypeHash(unittest.TestCase):
    def test_equals_the_published_hash_of_std_msgs_header(self):
        self.assertEqual(idl_model.type_hash(STRUCTS["std_msgs/msg/Header"], STRUCTS),
                         "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01")

    def test_equals_the_hashes_of_the_wire_recordings(self):
        shared = os.environ.get("RDS_SHARED")
        if not shared:
            self.skipTest("RDS_SHARED is not set: data/wire/typehashes.json is missing")
        hashes = json.loads((pathlib.Path(shared) / "data" / "wire" / "typehashes.json").read_text(encoding="utf-8"))
        del hashes["rmw_dds_common/msg/ParticipantEntitiesInfo"]  # of Humble, which says no hashes
        self.assertEqual({name: idl_model.type_hash(STRUCTS[name], STRUCTS) for name in hashes}, hashes)

    def test_equals_that_of_jazzy_where_humble_had_another_message(self):
        self.assertEqual(idl_model.type_hash(STRUCTS["rmw_dds_common/msg/ParticipantEntitiesInfo"], STRUCTS),
                         "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e")


    def test_equals_that_of_map_msgs(self):
        # SHA-256 of the type's description, put together of those parts of Jazzy's nav_msgs/msg/OccupancyGrid.json that are of the same types.
        self.assertEqual(idl_model.type_hash(STRUCTS["map_msgs/msg/OccupancyGridUpdate"], STRUCTS),
                         "RIHS01_c4095b0be2e4363f8978a1570e0293ee093436f1e1c61d99b48502ac317025e8")

    def test_equals_what_ros_announces_of_a_service_s_endpoints(self):
        for part, hash_of_part in (("_Request", "a1b0b5d6b967a5b8ac5bc8563c3ea678f349e312a6a4967227c5a96bc5ce38df"),
                                   ("_Response", "31b937b82de3612426be79f231e386259f97e8dc843e3f2845288b4bfa296bdd")):
            self.assertEqual(idl_model.type_hash(STRUCTS["rcl_interfaces/srv/ListParameters" + part], STRUCTS), "RIHS01_" + hash_of_part)

    def test_of_services_equals_that_of_jazzy(self):
        # the .json files of Jazzy's packages
        for name, hash_of_service in (("lifecycle_msgs/srv/GetState", "800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795"),
                                      ("lifecycle_msgs/srv/ChangeState", "356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5"),
                                      ("std_srvs/srv/SetBool", "abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a"), ("rcl_interfaces/srv/SetParameters", "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0"),
                                      ("nav_msgs/srv/GetMap", "c8ae77c9995b3554b5ba80e4d4d443f970ac65143102a1d893ec24fc07b31147")):
            with self.subTest(name):
                self.assertEqual(idl_model.service_hash(STRUCTS[name + "_Request"], STRUCTS), "RIHS01_" + hash_of_service)


class Definition(unittest.TestCase):
    def test_names_what_a_type_contains_each_once(self):
        text = idl_model.definition(STRUCTS["vision_msgs/msg/Detection2DArray"], STRUCTS)
        main, *parts = text.split("=" * 80 + "\n")
        self.assertEqual(main.splitlines(), idl_model.msg_lines(STRUCTS["vision_msgs/msg/Detection2DArray"]))
        names = [part.splitlines()[0] for part in parts]
        self.assertEqual(names, sorted(set(names)))
        self.assertIn("MSG: std_msgs/Header", names)
        for part in parts:
            name, *lines = part.splitlines()
            self.assertEqual(lines, idl_model.msg_lines(STRUCTS[name.removeprefix("MSG: ").replace("/", "/msg/")]))


class Parser(unittest.TestCase):
    def test_reads_every_kind_of_member(self):
        struct = parse("module p { module msg { module Name_Constants { const uint8 A = 1; };"
                       " struct Name { uint8 a; string<9> b; sequence<float> c; double d[3]; q::msg::T e; sequence<uint8, 4> _map; }; }; };")
        self.assertEqual(idl_model.msg_lines(struct),
                         ["uint8 A=1", "uint8 a", "string<=9 b", "float32[] c", "float64[3] d", "q/T e", "uint8[<=4] map"])

    def test_refuses_what_is_outside_the_restricted_idl(self):
        for member in ("long a;", "map<string, string> a;", "@optional uint8 a;", "sequence<string<4>> a;", "wstring a;"):
            with self.subTest(member), self.assertRaisesRegex(ValueError, "Name.idl"):
                parse("module p { module msg { struct Name { " + member + " }; }; };")

    def test_refuses_a_message_among_services(self):
        with self.assertRaisesRegex(ValueError, "expected module msg around Name"):
            parse("module p { module srv { struct Name { uint8 a; }; }; };")

    def test_refuses_a_struct_that_is_not_named_as_its_file(self):
        with self.assertRaisesRegex(ValueError, "one name"):
            parse("module p { module msg { struct Other { uint8 a; }; }; };")


if __name__ == "__main__":
    unittest.main()
