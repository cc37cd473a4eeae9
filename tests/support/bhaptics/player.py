#!/usr/bin/env python3
"""Stands in for bHaptics' Player: a strict server of its websocket.

It prints "listening on PORT", "connected" for each connection, "on" when a vibrator begins to run and "off" when none
runs any more.
When a connection has ended, it prints a JSON object: "texts" (taken), "frames" (of them, those with a state), "most"
(the largest intensity of each vibrator), "left_on" (the vibrators that still ran after the last text, had time stood
still) and "faults" (texts and requests that a strict Player refuses). It ends after `--connections`.
"""
import argparse
import asyncio
import contextlib
import json
import urllib.parse

import websockets

SIZES = {"VestFront": 20, "VestBack": 20, "Head": 6, "ForearmL": 6, "ForearmR": 6, "HandL": 3, "HandR": 3, "FootL": 3,
         "FootR": 3}
STATUS = {"RegisteredKeys": [], "ActiveKeys": [], "ConnectedDeviceCount": 1,
          "ConnectedPositions": ["VestFront", "VestBack"], "Status": {"VestFront": [0] * 20, "VestBack": [0] * 20}}


class Fault(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Fault(what)


def require_keys(value, keys):
    require(isinstance(value, dict) and set(value) == set(keys), f"not the fields {keys}: {value}")


def require_whole(value, least, most, what):
    require(type(value) is int and least <= value <= most, f"{what} is {value}, not {least} to {most}")


class Player:
    """The state that requests leave behind."""

    def __init__(self, most_ms):
        self.most_ms = most_ms
        self.playing = {}  # of each key: the intensities that are not 0
        self.most = {}
        self.texts = self.frames = 0
        self.faults = []

    def take(self, text):
        self.texts += 1
        try:
            require(isinstance(text, str), "not a text")
            request = json.loads(text)
            require_keys(request, ["Submit"])
            require(isinstance(request["Submit"], list) and request["Submit"], "nothing is submitted")
            kinds = {submitted.get("Type") for submitted in request["Submit"]}
            for submitted in request["Submit"]:
                self.submit(submitted)
            self.frames += kinds == {"frame"}
        except (Fault, ValueError) as fault:
            self.faults.append(str(fault))

    def submit(self, submitted):
        if submitted.get("Type") == "turnOff":
            require_keys(submitted, ["Type", "Key"])
            self.playing.pop(submitted["Key"], None)
            return
        require_keys(submitted, ["Type", "Key", "Frame"])
        require(submitted["Type"] == "frame", f"the type {submitted['Type']}")
        require(isinstance(submitted["Key"], str) and submitted["Key"], "no key")
        frame = submitted["Frame"]
        require_keys(frame, ["Position", "DotPoints", "PathPoints", "DurationMillis"])
        require(frame["Position"] in SIZES, f"the position {frame['Position']}")
        require(frame["PathPoints"] == [], "points of paths")
        require_whole(frame["DurationMillis"], 1, self.most_ms, "DurationMillis")
        levels = {}
        for dot in frame["DotPoints"]:
            require_keys(dot, ["Index", "Intensity"])
            require_whole(dot["Index"], 0, SIZES[frame["Position"]] - 1, "Index")
            require_whole(dot["Intensity"], 0, 100, "Intensity")
            name = f"{frame['Position']} {dot['Index']}"
            require(name not in levels, f"{name} twice")
            levels[name] = dot["Intensity"]
        for name, level in levels.items():
            self.most[name] = max(self.most.get(name, 0), level)
        self.playing[submitted["Key"]] = {name: level for name, level in levels.items() if level > 0}

    def left_on(self):
        return sorted(name for levels in self.playing.values() for name in levels)


def say(line):
    print(line, flush=True)


async def serve(connection, options, player):
    path = urllib.parse.urlsplit(connection.path)
    query = urllib.parse.parse_qs(path.query, strict_parsing=True)
    if path.path != "/v2/feedbacks" or not query.get("app_id") or not query.get("app_name"):
        player.faults.append(f"asked for {connection.path}")
    say("connected")
    if options.deaf:
        connection.transport.pause_reading()
        await asyncio.sleep(600)
    if options.breaks:
        connection.transport.write(b"\xff\xff\xff\xff not a frame of a websocket")
    was_on = False
    async for text in connection:
        player.take(text)
        if bool(player.left_on()) != was_on:
            was_on = not was_on
            say("on" if was_on else "off")
        with contextlib.suppress(websockets.ConnectionClosed):  # more texts may have come before that
            if options.garbage:
                await connection.send("{\"Status\": [" + "x" * 100_000)
                await connection.send(bytes(range(256)))
                await connection.ping()
            elif player.texts % 10 == 1:
                await connection.send(json.dumps(STATUS))
        if player.texts == options.texts:
            return  # closes


async def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--most-ms", type=int, default=60, help="longest duration of a frame")
    parser.add_argument("--connections", type=int, default=1)
    parser.add_argument("--texts", type=int, default=-1, help="close a connection after so many texts")
    parser.add_argument("--refuse", action="store_true", help="refuse the handshake")
    parser.add_argument("--deaf", action="store_true", help="read nothing after the handshake")
    parser.add_argument("--garbage", action="store_true", help="answer each text with nonsense")
    parser.add_argument("--breaks", action="store_true", help="break the protocol of websockets")
    options = parser.parse_args()
    ended = asyncio.Semaphore(0)

    async def handle(connection):
        player = Player(options.most_ms)
        try:
            await serve(connection, options, player)
        except websockets.ConnectionClosed as closed:
            if not options.breaks:
                player.faults.append(str(closed))
        say(json.dumps({"texts": player.texts, "frames": player.frames, "most": player.most,
                        "left_on": player.left_on(), "faults": player.faults[:5]}))
        ended.release()

    async def refuse(_path, _headers):
        return (403, [], b"no") if options.refuse else None

    async with websockets.serve(handle, "127.0.0.1", options.port, process_request=refuse) as server:
        say(f"listening on {server.sockets[0].getsockname()[1]}")
        for _ in range(options.connections):
            await ended.acquire()


asyncio.run(main())
