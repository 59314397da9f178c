# SPDX-License-Identifier: Apache-2.0
"""ros_services.py TRACKER MAPPER (look N M | set HEIGHT | reset | lifecycle | managed | shutdown): what an ordinary ROS 2 node is told by
the services of our nodes, as one line of JSON.

TRACKER, MAPPER  full names ("/rds_tracker"). With `look` it reads all that they tell, once it has heard of N services of the tracker and M of the mapper (ROS
hears of a node's endpoints one by one, after the node has answered the first requests already). With `set` it changes settings of the mapper while it runs, the
grid's lowest height to HEIGHT. With `reset` it asks the mapper for that alone: whoever looks at
the grid meanwhile finds it empty. With `lifecycle` it takes the tracker through its states, as `ros2 lifecycle` and Nav2's manager do; with `managed` it brings
one up that begins unconfigured; with `shutdown` it ends it.
"""

import json
import sys
import time

import rclpy
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from nav_msgs.srv import GetMap
from rcl_interfaces.msg import Log, Parameter, ParameterEvent, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes, ListParameters, SetParameters, SetParametersAtomically
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_srvs.srv import SetBool, Trigger

LIMIT_S = 20
VALUES = {ParameterType.PARAMETER_BOOL: "bool_value", ParameterType.PARAMETER_INTEGER: "integer_value", ParameterType.PARAMETER_DOUBLE: "double_value",
          ParameterType.PARAMETER_STRING: "string_value", ParameterType.PARAMETER_STRING_ARRAY: "string_array_value"}


def a_parameter(name, value):
    kind = {bool: ParameterType.PARAMETER_BOOL, int: ParameterType.PARAMETER_INTEGER, float: ParameterType.PARAMETER_DOUBLE, str: ParameterType.PARAMETER_STRING}[type(value)]
    return Parameter(name=name, value=ParameterValue(type=kind, **{VALUES[kind]: value}))


class Asker:
    def __init__(self, node):
        self.node = node

    def ask(self, kind, name, **request):
        client = self.node.create_client(kind, name)
        if not client.wait_for_service(timeout_sec=LIMIT_S):
            raise TimeoutError(f"no {name}")
        future = client.call_async(kind.Request(**request))
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=LIMIT_S)
        if not future.done():
            raise TimeoutError(f"no answer of {name}")
        self.node.destroy_client(client)
        return future.result()

    def parameters(self, of):
        """What `ros2 param list`, `get`, `describe` and `set` ask for."""
        names = list(self.ask(ListParameters, f"{of}/list_parameters").result.names)
        values = self.ask(GetParameters, f"{of}/get_parameters", names=names).values
        types = list(self.ask(GetParameterTypes, f"{of}/get_parameter_types", names=names).types)
        descriptors = self.ask(DescribeParameters, f"{of}/describe_parameters", names=names).descriptors
        one = [a_parameter("nice", 3)]
        return {"values": {n: getattr(v, VALUES[v.type]) for n, v in zip(names, values, strict=True)},
                "types_agree": types == [v.type for v in values] == [d.type for d in descriptors],
                "descriptions": {d.name: d.description for d in descriptors}, "live": [d.name for d in descriptors if not d.read_only],
                "refusals": [[r.successful, r.reason] for r in (self.ask(SetParameters, f"{of}/set_parameters", parameters=one).results[0],
                                                                self.ask(SetParametersAtomically, f"{of}/set_parameters_atomically", parameters=one).result)]}

    def services(self, of, number):
        """Of the node, once `number` of them are known. @raise TimeoutError for fewer after 20 s."""
        above, _, name = of.rpartition("/")
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            if (name, above or "/") in self.node.get_node_names_and_namespaces():
                known = dict(self.node.get_service_names_and_types_by_node(name, above or "/"))
                if len(known) >= number:
                    return known
            time.sleep(0.1)
        raise TimeoutError(f"fewer than {number} services of {of}")


class Life:
    """The lifecycle of a node, and what it tells of it."""

    def __init__(self, asker, of):
        self.asker, self.of, self.events = asker, of, []
        asker.node.create_subscription(TransitionEvent, f"{of}/transition_event", self.take, 10)
        while asker.node.count_publishers(f"{of}/transition_event") == 0:
            rclpy.spin_once(asker.node, timeout_sec=0.1)

    def take(self, event):
        self.events.append([event.start_state.label, event.transition.label, event.goal_state.label])

    def state(self):
        return self.asker.ask(GetState, f"{self.of}/get_state").current_state.label

    def transitions(self, service="get_available_transitions"):
        return [t.transition.label for t in self.asker.ask(GetAvailableTransitions, f"{self.of}/{service}").available_transitions]

    def change(self, **transition):
        """As `ros2 lifecycle set` asks. @return whether it was done, and the state after it."""
        return [self.asker.ask(ChangeState, f"{self.of}/change_state", transition=Transition(**transition)).success, self.state()]


def lifecycle(asker, of):
    life = Life(asker, of)
    told = {"states": [s.label for s in asker.ask(GetAvailableStates, f"{of}/get_available_states").available_states],
            "graph": life.transitions("get_transition_graph"), "at_first": [life.state(), life.transitions()],
            "refused": [life.change(id=Transition.TRANSITION_ACTIVATE), life.change(id=Transition.TRANSITION_CLEANUP), life.change(id=77), life.change(label="fly")],
            "done": [life.change(id=Transition.TRANSITION_DEACTIVATE)], "inactive": life.transitions()}
    told["refused_inactive"] = life.change(id=Transition.TRANSITION_DEACTIVATE)
    told["done"] += [life.change(label=label) for label in ("cleanup", "configure", "activate")]
    told["by_pause"] = [[asker.ask(SetBool, f"{of}/pause", data=data).success, life.state()] for data in (True, False)]
    for _ in range(50):
        if len(life.events) >= 10:
            break
        rclpy.spin_once(asker.node, timeout_sec=0.1)
    return {**told, "events": life.events}


def managed(asker, of):
    """What Nav2's lifecycle manager does at the start."""
    life = Life(asker, of)
    return [life.state(), life.change(id=Transition.TRANSITION_CONFIGURE), life.change(id=Transition.TRANSITION_ACTIVATE)]


def set_live(asker, of, height):
    """What `ros2 param set` does. @return results, the changes that were told to all, and how many cells of the grid are occupied before and after."""
    events, logs = [], []
    asker.node.create_subscription(ParameterEvent, "/parameter_events", events.append, 1000)
    asker.node.create_subscription(Log, "/rosout", logs.append, QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def results(*parameters):
        return [[r.successful, r.reason] for r in asker.ask(SetParameters, f"{of}/set_parameters", parameters=[a_parameter(*p) for p in parameters]).results]

    def occupied():
        return sum(c == 100 for c in asker.ask(GetMap, f"{of}/map").map.data)

    told = {"occupied": [occupied()],
            "results": results(("grid.min_height_m", height), ("grid.max_height_m", -1000.0), ("full_map_every", "often"), ("octree.resolution_m", 0.1), ("log_level", "debug"))}
    together = asker.ask(SetParametersAtomically, f"{of}/set_parameters_atomically", parameters=[a_parameter("log_level", "info"), a_parameter("full_map_every", 0)])
    told["together"] = [together.result.successful, together.result.reason]
    told["values"] = [getattr(v, VALUES[v.type]) for v in asker.ask(GetParameters, f"{of}/get_parameters", names=["grid.min_height_m", "grid.max_height_m", "log_level"]).values]
    told["occupied"].append(occupied())
    end = time.monotonic() + LIMIT_S
    while (sum(event.node == of for event in events) < 2 or not logged(logs, of)) and time.monotonic() < end:
        rclpy.spin_once(asker.node, timeout_sec=0.1)
    told["events"] = [[p.name, getattr(p.value, VALUES[p.value.type])] for event in events if event.node == of for p in event.changed_parameters]
    return {**told, "logged": logged(logs, of)}


def logged(logs, of):
    """What a node says of a setting that was changed."""
    return [[log.level, log.msg] for log in logs if log.name == of[1:].replace("/", ".") and log.msg.startswith("log_level is debug")][-1:]


def reset(asker, mapper):
    return asker.ask(Trigger, f"{mapper}/reset").success


def look(asker, tracker, mapper, numbers):
    told = {of: asker.parameters(of) for of in (tracker, mapper)}
    for of, number in zip((tracker, mapper), numbers, strict=True):
        told[of]["state"] = asker.ask(GetState, f"{of}/get_state").current_state.label
        told[of]["services"] = asker.services(of, number)
    grid = asker.ask(GetMap, f"{mapper}/map").map
    told["grid"] = {"frame": grid.header.frame_id, "width": grid.info.width, "height": grid.info.height, "occupied": sum(c == 100 for c in grid.data)}
    told["commands"] = [asker.ask(SetBool, f"{tracker}/pause", data=data).message for data in (True, False)]
    return told


def main():
    tracker, mapper = sys.argv[1:3]
    rclpy.init()
    node = rclpy.create_node("asker")
    asker = Asker(node)
    wanted = {"look": lambda: look(asker, tracker, mapper, [int(number) for number in sys.argv[4:]]), "set": lambda: set_live(asker, mapper, float(sys.argv[4])), "reset": lambda: reset(asker, mapper),
              "lifecycle": lambda: lifecycle(asker, tracker), "managed": lambda: managed(asker, tracker),
              "shutdown": lambda: asker.ask(ChangeState, f"{tracker}/change_state", transition=Transition(id=Transition.TRANSITION_ACTIVE_SHUTDOWN)).success}
    print(json.dumps(wanted[sys.argv[3]]()), flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
