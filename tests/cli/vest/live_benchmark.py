#!/usr/bin/env python3
"""Measures how long `vestige live` takes from a datagram's arrival to the last byte written.

Sends, over loopback, 100 colliders 1000 times a second and a pose 90 times a second to a live session, which feels them
on a simulated board (--board) or a file. Prints the session's latencies as a table, and its memory after the first tenth
of the time and at the end. --busy keeps every core busy with something else meanwhile.

Usage: live_benchmark.py [--bin FOLDER] [--board FIRMWARE.elf] [--seconds S] [--busy] [--json OUT.json] [FLAG of live ...]
"""
import argparse
import json
import math
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

COLLIDERS = 100
COLLIDER_HZ = 1000
POSE_HZ = 90


def text(value):
    data = value.encode() + b"\0"
    return data + b"\0" * (-len(data) % 4)


def message(address, types, *values):
    data = text(address) + text("," + types)
    for kind, value in zip(types, values):
        data += text(value) if kind == "s" else struct.pack(">" + kind, value)
    return data


def bundle(messages):
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">i", len(one)) + one for one in messages)


def colliders(time_s):
    """A ring of colliders that goes in and out of the body's middle."""
    out = []
    for i in range(COLLIDERS):
        angle = 2 * math.pi * i / COLLIDERS
        radius_m = 0.25 + 0.2 * math.sin(2 * math.pi * (time_s + i / COLLIDERS))
        out.append(message("/vestige/collider", "ifff", i, radius_m * math.cos(angle), 1.0 + 0.3 * (i % 5) / 5,
                           radius_m * math.sin(angle)))
    return bundle(out)


def pose(time_s):
    sway_m = 0.05 * math.sin(2 * math.pi * time_s)
    return bundle([message("/VMC/Ext/Root/Pos", "sfffffff", "root", sway_m, 0, 0, 0, 0, 0, 1),
                   message("/VMC/Ext/OK", "i", 1)])


def send(port, seconds, after_a_tenth):
    # Both motions repeat after a second.
    collider_bundles = [colliders(k / COLLIDER_HZ) for k in range(COLLIDER_HZ)]
    pose_bundles = [pose(k / POSE_HZ) for k in range(POSE_HZ)]
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.connect(("127.0.0.1", port))
    begin = time.monotonic()
    next_pose = 0
    frames = int(seconds * COLLIDER_HZ)
    for k in range(frames):
        time.sleep(max(0, begin + k / COLLIDER_HZ - time.monotonic()))
        if k * POSE_HZ >= next_pose * COLLIDER_HZ:
            out.send(pose_bundles[next_pose % POSE_HZ])
            next_pose += 1
        out.send(collider_bundles[k % COLLIDER_HZ])
        if k == frames // 10:
            after_a_tenth()


def memory_mb(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1e3
    sys.exit("live_benchmark.py: the session has no memory")


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def await_true(is_true):
    for _ in range(600):
        if is_true():
            return
        time.sleep(0.05)
    sys.exit("live_benchmark.py: nothing began within 30 s")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--board", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--busy", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    options, flags = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as folder_name:
        folder = pathlib.Path(folder_name)
        board = None
        if options.board:
            board = subprocess.Popen([options.bin / "simulated_board", options.board, "--link", folder / "vest"],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            await_true(lambda: os.path.exists(folder / "vest"))
        port = free_port()
        error = folder / "error"
        with error.open("w") as stream:
            live = subprocess.Popen(["vestige", "live", "--from", f"vmc://127.0.0.1:{port}", "--port",
                                     "vest" if board else "file:felt", "--json", "live.json", *flags], cwd=folder,
                                    executable=options.bin.resolve() / "vestige", stdout=subprocess.DEVNULL,
                                    stderr=stream)
        await_true(lambda: "listening" in error.read_text())
        neighbours = [subprocess.Popen([sys.executable, "-c", "while True: pass"])
                      for _ in range(os.cpu_count() if options.busy else 0)]
        memory = []
        send(port, options.seconds, lambda: memory.append(memory_mb(live)))
        memory.append(memory_mb(live))
        for neighbour in neighbours:
            neighbour.kill()
            neighbour.wait()
        live.send_signal(signal.SIGINT)
        code = live.wait()
        if board:
            board.send_signal(signal.SIGINT)
            board.wait()
        print(error.read_text(), end="")
        text_of_session = (folder / "live.json").read_text()
    if options.json:
        options.json.write_text(text_of_session)
    session = json.loads(text_of_session)
    print(f"exit code {code}: {session['frames']} frames, {session['frames_superseded']} superseded, "
          f"{session['contacts']} contacts, {session['changes']} changes, {session['lost']} lost")
    print(f"memory after a tenth of the time {memory[0]:.1f} MB, at the end {memory[1]:.1f} MB")
    for stage, values in session["latency"].items():
        if values["count"] == 0:
            continue
        print(f"{stage:<24} " + "  ".join(f"{name} {values[name]:8.3f}" for name in ("p50_ms", "p95_ms", "p99_ms", "max_ms")))


if __name__ == "__main__":
    main()
