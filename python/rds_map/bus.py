# SPDX-License-Identifier: Apache-2.0
"""The topics, by PyPI's cyclonedds: whichever vendor the services use, it hears them."""

import dataclasses
import os

from cyclonedds.core import Policy, Qos, ReadCondition, InstanceState, SampleState, ViewState, WaitSet
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

_LOOPBACK = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/>
</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>60</MaxAutoParticipantIndex><Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""
_AT_ONCE = 1000  # samples that one look takes
_loopback_domains = {}  # by number: a process configures each once


class Bus:
    """One participant of a domain; CYCLONEDDS_URI configures it, as any program of Cyclone DDS."""

    def __init__(self, domain=None, namespace="", loopback=False):
        """@param domain  default: ROS_DOMAIN_ID or 0. @param namespace  of the robot: "robot1".
        @param loopback  this machine only, as `rds run` without --network is.
        """
        number = int(os.environ.get("ROS_DOMAIN_ID") or 0) if domain is None else domain
        if loopback and number not in _loopback_domains:
            _loopback_domains[number] = Domain(number, _LOOPBACK)
        self._participant = DomainParticipant(number)
        self._prefix = "rt/" + (namespace.strip("/") + "/" if namespace.strip("/") else "")

    def reader(self, name, message, depth, latched=False):
        """@param depth  messages that wait until they are taken. @param latched  what was said before is wanted, too."""
        qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)),
                  Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
                  Policy.History.KeepLast(depth), Policy.DataRepresentation(use_cdrv0_representation=True))
        topic = Topic(self._participant, self._prefix + name, message, qos=qos)
        return Reader(name, message, DataReader(self._participant, topic, qos=qos))

    def wait_set(self, readers):
        """Something to wait for messages of any of these readers with: wait(duration)."""
        waits = WaitSet(self._participant)
        for reader in readers:
            waits.attach(reader.has_new)
        return waits


@dataclasses.dataclass(eq=False)
class Reader:
    """Of one topic."""

    name: str
    message: type
    _reader: DataReader

    def __post_init__(self):
        self.has_new = ReadCondition(self._reader, ViewState.Any | InstanceState.Any | SampleState.NotRead)

    def take(self):
        """What has come since, as bytes, oldest first."""
        return [sample.data for sample in self._reader.take(N=_AT_ONCE) if hasattr(sample, "data")]
