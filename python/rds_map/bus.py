# SPDX-License-Identifier: Apache-2.0
"""The topics, by PyPI's cyclonedds: whichever vendor the services use, it hears them."""

import dataclasses
import os
import socket

from cyclonedds.core import Policy, Qos, ReadCondition, InstanceState, SampleState, ViewState, WaitSet
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

_LOOPBACK = """<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>"""
_AT_ONCE = 1000  # samples that one look takes
_domains = {}  # by number: a process configures each once


def _addresses(names):
    """Of names or addresses with commas between them. @throws ValueError with one sentence."""
    addresses = []
    for name in filter(None, names.split(",")):
        try:
            addresses.append(socket.gethostbyname(name))
        except OSError as e:
            raise ValueError(f"peer '{name}': {e.strerror}") from e
    return addresses


def _settings(loopback, addresses):
    """For Cyclone DDS; what the user's own file says wins."""
    peers = "".join(f'<Peer Address="{address}"/>' for address in ["127.0.0.1", *addresses])
    return f"""<CycloneDDS><Domain Id="any">{_LOOPBACK if loopback else ""}<Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex><Peers>{peers}</Peers>
</Discovery></Domain></CycloneDDS>,{os.environ.get("CYCLONEDDS_URI", "")}"""


class Bus:
    """One participant of a domain; CYCLONEDDS_URI configures it, as any program of Cyclone DDS."""

    def __init__(self, domain=None, namespace="", loopback=False, peers=None):
        """@param domain  default: ROS_DOMAIN_ID or 0. @param namespace  of the robot: "robot1".
        @param loopback  this machine only, as `rds run` without --network is.
        @param peers  other machines, where the network has no multicast: "robot,10.0.0.7"; default: RDS_PEERS.
        @throws ValueError for a name that nobody has.
        """
        number = int(os.environ.get("ROS_DOMAIN_ID") or 0) if domain is None else domain
        addresses = _addresses(os.environ.get("RDS_PEERS", "") if peers is None else peers)
        if (loopback or addresses) and number not in _domains:
            _domains[number] = Domain(number, _settings(loopback, addresses))
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
