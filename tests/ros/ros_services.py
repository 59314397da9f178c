# SPDX-License-Identifier: Apache-2.0
"""ros_services.py TRACKER MAPPER [reset]: what an ordinary ROS 2 node is told by the services of our nodes, as one line of JSON.

TRACKER, MAPPER  full names ("/rds_tracker"). With `reset` it asks the mapper for that alone: whoever looks at the grid meanwhile finds it empty.
"""

import json
import sys

import rclpy
from lifecycle_msgs.srv import GetState
from nav_msgs.srv import GetMap
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes, ListParameters, SetParameters, SetParametersAtomically
from std_srvs.srv import SetBool, Trigger

LIMIT_S = 20
VALUES = {ParameterType.PARAMETER_BOOL: "bool_value", ParameterType.PARAMETER_INTEGER: "integer_value", ParameterType.PARAMETER_DOUBLE: "double_value",
          ParameterType.PARAMETER_STRING: "string_value", ParameterType.PARAMETER_STRING_ARRAY: "string_array_value"}


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
        one = [Parameter(name=names[0], value=ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True))]
        return {"values": {n: getattr(v, VALUES[v.type]) for n, v in zip(names, values, strict=True)},
                "types_agree": types == [v.type for v in values] == [d.type for d in descriptors],
                "descriptions": {d.name: d.description for d in descriptors}, "read_only": all(d.read_only for d in descriptors),
                "refusals": [[r.successful, r.reason] for r in (self.ask(SetParameters, f"{of}/set_parameters", parameters=one).results[0],
                                                                self.ask(SetParametersAtomically, f"{of}/set_parameters_atomically", parameters=one).result)]}

    def services(self, of):
        above, _, name = of.rpartition("/")
        return dict(self.node.get_service_names_and_types_by_node(name, above or "/"))


def reset(asker, mapper):
    return asker.ask(Trigger, f"{mapper}/reset").success


def look(asker, tracker, mapper):
    told = {of: asker.parameters(of) for of in (tracker, mapper)}
    for of in (tracker, mapper):
        told[of]["state"] = asker.ask(GetState, f"{of}/get_state").current_state.label
        told[of]["services"] = asker.services(of)
    grid = asker.ask(GetMap, f"{mapper}/map").map
    told["grid"] = {"frame": grid.header.frame_id, "width": grid.info.width, "height": grid.info.height, "occupied": sum(c == 100 for c in grid.data)}
    told["commands"] = [asker.ask(SetBool, f"{tracker}/pause", data=data).message for data in (True, False)]
    return told


def main():
    tracker, mapper = sys.argv[1:3]
    rclpy.init()
    node = rclpy.create_node("asker")
    asker = Asker(node)
    told = reset(asker, mapper) if sys.argv[3:] == ["reset"] else look(asker, tracker, mapper)
    print(json.dumps(told), flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
