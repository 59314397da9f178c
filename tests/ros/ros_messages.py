# SPDX-License-Identifier: Apache-2.0
"""ros_messages.py FOLDER TYPES [MAP]: an ordinary ROS 2 node that reads every topic with a type of rds_msgs, the package in FOLDER, and commands the tracker.

Writes, as one line of JSON, of each type that is announced the hashes that its endpoints tell, and the answer to the command. FOLDER/wire/TYPE is the last message
of each type, as it came, FOLDER/wire/TYPE.python what the node makes of it again. Ends when messages of so many TYPES have come, after 60 s at most; with MAP it
then has the services save their map under that name, load it, and load one that is not there, and writes how that went, too.
"""

import importlib
import json
import pathlib
import sys
import time

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message, serialize_message

FOLDER = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(FOLDER))
messages = importlib.import_module("rds_msgs.msg")
services = importlib.import_module("rds_msgs.srv")


class Reader:
    def __init__(self, node):
        self.node, self.subscriptions, self.types, self.hashes, self.answers = node, {}, set(), {}, []
        self.commands = node.create_publisher(messages.Command, "/rds/command", 10)
        node.create_subscription(messages.CommandResult, "/rds/command_result", self.answers.append, 10)

    def look(self):
        """For topics that were not there before."""
        for topic, types in self.node.get_topic_names_and_types():
            package, _, name = types[0].split("/")
            if package != "rds_msgs":
                continue
            writers = self.node.get_publishers_info_by_topic(topic)
            others = [e for e in [*writers, *self.node.get_subscriptions_info_by_topic(topic)] if e.node_name != self.node.get_name()]
            self.hashes.setdefault(name, set()).update(str(endpoint.topic_type_hash) for endpoint in others)
            if writers and topic not in self.subscriptions:
                self.subscribe(topic, name, writers[0].qos_profile)

    def subscribe(self, topic, name, qos):
        latched = qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
        mine = QoSProfile(depth=10, reliability=qos.reliability, durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE)
        self.subscriptions[topic] = self.node.create_subscription(getattr(messages, name), topic, lambda raw: self.take(name, raw), mine, raw=True)

    def take(self, name, raw):
        self.types.add(name)
        (FOLDER / "wire" / name).write_bytes(raw)
        (FOLDER / "wire" / f"{name}.python").write_bytes(serialize_message(deserialize_message(raw, getattr(messages, name))))

    def run(self, types, limit_s=60):
        end = time.monotonic() + limit_s
        while time.monotonic() < end and (len(self.types) < types or not self.answers):
            self.look()
            if not self.answers:
                self.commands.publish(messages.Command(request_id=25, target="rds-tracker", verb="status"))
            until = time.monotonic() + 1
            while time.monotonic() < until:
                rclpy.spin_once(self.node, timeout_sec=0.1)


def ask(node, kind, name, argument, limit_s=30):
    client = node.create_client(kind, name)
    if not client.wait_for_service(timeout_sec=limit_s):
        raise TimeoutError(f"no {name}")
    future = client.call_async(kind.Request(name=argument))
    rclpy.spin_until_future_complete(node, future, timeout_sec=limit_s)
    return [future.result().success, future.result().message]


def save_and_load(node, name):
    return {"save": ask(node, services.SaveMap, "/rds_tracker/save_map", name), "load": ask(node, services.LoadMap, "/rds_tracker/load_map", name),
            "load_another": ask(node, services.LoadMap, "/rds_tracker/load_map", name + "_2")}


def main():
    rclpy.init()
    (FOLDER / "wire").mkdir(exist_ok=True)
    reader = Reader(rclpy.create_node("reader"))
    reader.run(int(sys.argv[2]))
    told = save_and_load(reader.node, sys.argv[3]) if sys.argv[3:] else {}
    print(json.dumps({**told, "hashes": {name: sorted(hashes) for name, hashes in reader.hashes.items()},
                      "answers": [[answer.request_id, answer.service, answer.success] for answer in reader.answers[:1]]}), flush=True)


if __name__ == "__main__":
    main()
