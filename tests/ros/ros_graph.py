# SPDX-License-Identifier: Apache-2.0
"""ros_graph.py NODES: what an ordinary ROS 2 node sees of the graph, as one line of JSON.

Looks until it knows so many other nodes and all endpoints of theirs that are announced, for at most 40 s.
"""

import json
import sys
import time

import rclpy

UNKNOWN = ("_NODE_NAME_UNKNOWN_", "_CREATED_BY_BARE_DDS_APP_")


def endpoint(info):
    return {"node": "/".join((info.node_namespace.rstrip("/"), info.node_name)), "type": info.topic_type, "hash": str(info.topic_type_hash),
            "reliable": info.qos_profile.reliability.name == "RELIABLE", "latched": info.qos_profile.durability.name == "TRANSIENT_LOCAL"}


def graph_of(node):
    nodes = sorted("/".join((space.rstrip("/"), name)) for name, space in node.get_node_names_and_namespaces() if name != node.get_name())
    topics = {name: {"publishers": [endpoint(i) for i in node.get_publishers_info_by_topic(name)],
                     "subscribers": [endpoint(i) for i in node.get_subscriptions_info_by_topic(name)]}
              for name, _ in node.get_topic_names_and_types()}
    by_node = {full: {"publishers": dict(node.get_publisher_names_and_types_by_node(full.rsplit("/", 1)[1], full.rsplit("/", 1)[0] or "/")),
                      "subscribers": dict(node.get_subscriber_names_and_types_by_node(full.rsplit("/", 1)[1], full.rsplit("/", 1)[0] or "/"))}
               for full in nodes}
    return {"nodes": nodes, "topics": topics, "by_node": by_node}


def is_settled(graph, nodes):
    endpoints = [e for topic in graph["topics"].values() for ends in topic.values() for e in ends]
    return len(graph["nodes"]) >= nodes and not any(unknown in e["node"] for e in endpoints for unknown in UNKNOWN)


def main():
    rclpy.init()
    node = rclpy.create_node("looker")
    end = time.monotonic() + 40
    settled, graph = 0, {}
    while settled < 3 and time.monotonic() < end:  # seconds without a change to wait for
        time.sleep(1)
        before, graph = graph, graph_of(node)
        settled = settled + 1 if graph == before and is_settled(graph, int(sys.argv[1])) else 0
    print(json.dumps(graph), flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
