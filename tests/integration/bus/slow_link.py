# SPDX-License-Identifier: Apache-2.0
"""A link of TCP that takes its time."""

import asyncio
import threading


class SlowLink:
    """What is sent to 127.0.0.1:`port` arrives at 127.0.0.1:`target` after `delay` seconds, and the other way."""

    def __init__(self, port, target, delay):
        self.port, self.target, self.delay = port, target, delay
        self.loop = asyncio.new_event_loop()

    async def pump(self, reader, writer):
        while data := await reader.read(1 << 16):
            self.loop.call_later(self.delay, writer.write, data)
        self.loop.call_later(self.delay, writer.close)

    async def join(self, reader, writer):
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.target)
        await asyncio.gather(self.pump(reader, far_writer), self.pump(far_reader, writer), return_exceptions=True)

    def __enter__(self):
        self.loop.run_until_complete(asyncio.start_server(self.join, "127.0.0.1", self.port))
        self.thread = threading.Thread(target=self.loop.run_forever)
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()
