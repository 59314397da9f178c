# SPDX-License-Identifier: Apache-2.0
"""Somebody on Zenoh who is not ours, for zenoh_secured_test.py: zenoh_intruder.py JSON

JSON: {"config": Zenoh's, "put": key or null, "payload": hex, "listen": key expression, "domain": number, "seconds": number}. Puts the payload at the
key ten times a second, in the form of rmw_zenoh, and says with a token that it does. Prints {"opened": bool, "heard": number of others' messages,
"tokens": number of others that are seen}.
"""
import json
import struct
import sys
import time

import zenoh

todo = json.loads(sys.argv[1])
report = {"opened": False, "heard": 0, "tokens": 0}


def on_sample(_sample):
    report["heard"] += 1


try:
    with zenoh.open(zenoh.Config.from_json5(json.dumps(todo["config"]))) as session:
        report["opened"] = True
        subscriber = session.declare_subscriber(todo["listen"], on_sample, allowed_origin=zenoh.Locality.REMOTE)
        me = f"@ros2_lv/{todo['domain']}/{session.zid()}"
        if todo["put"]:
            _, *topic, kind, type_hash = todo["put"].split("/")
            token = session.liveliness().declare_token(f"{me}/0/1/MP/%/%/intruder/%{'%'.join(topic)}/{kind}/{type_hash}/::,10:,:,:,,")
        end = time.monotonic() + todo["seconds"]
        number = 0
        while time.monotonic() < end:
            if todo["put"]:
                number += 1
                session.put(todo["put"], bytes.fromhex(todo["payload"]), attachment=struct.pack("<qqB16s", number, time.time_ns(), 16, b"intruder"))
            time.sleep(.1)
        seen = session.liveliness().get(f"@ros2_lv/{todo['domain']}/**", timeout=2)
        report["tokens"] = sum(not str(reply.ok.key_expr).startswith(me) for reply in seen if reply.ok)
except zenoh.ZError as error:
    report["error"] = str(error)
print(json.dumps(report))
