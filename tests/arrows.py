#!/usr/bin/env python3
"""Checks the rooms of the house (CONTRIBUTING.md). Prints every break as FILE:LINE: RULE, and exits with 1 if there is one.

1. A file includes only its own room and the rooms that its room USES: the vestige_room calls in the CMakeLists.txt files.
2. The rooms form no circle.
3. Every folder with sources is a room, and CONTRIBUTING.md has a row for it.
4. No folder holds more than 25 files that are written by hand.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_FILES = 25
# Not C++, or a program that is built alone.
ALONE = {"shaders": set(), "transport/firmware": set(), "traces/mannequin": {"traces/scene", "traces/gltf"}}
# One file for each shader, run or seed, or written by a program.
UNCOUNTED = ("results/", "docs/reference", "tests/fuzz/seeds/", "shaders")

problems = []


def report(where, rule):
    problems.append(f"{where}: {rule}")


def rooms_of(files):
    """Room -> the rooms that it uses, in the order of the vestige_room calls."""
    rooms = {}
    for file in (f for f in files if f.endswith("CMakeLists.txt")):
        text = (ROOT / file).read_text()
        for call in re.finditer(r"^ *vestige_room\(([^)]*)\)", text, re.M):
            folder, *words = call[1].split()
            used, keyword = set(), None
            for word in words:
                if word.isupper():
                    keyword = word
                elif keyword == "USES":
                    used.add(word)
            rooms[folder] = used
    return rooms


def refuse_circles(rooms):
    done, path = set(), []

    def visit(room):
        if room in path:
            report(room, "a circle of rooms: " + " -> ".join(path[path.index(room):] + [room]))
        elif room not in done:
            path.append(room)
            for used in sorted(rooms.get(room, ())):
                visit(used)
            path.pop()
            done.add(room)

    for room in rooms:
        visit(room)


def refuse_includes(files, rooms):
    for file in files:
        if not re.search(r"\.(cpp|hpp|h)$", file) or file.startswith("tests/"):
            continue
        room = str(pathlib.PurePath(file).parent)
        if room not in rooms:
            report(file, f"{room} is no room: it needs a vestige_room call in a CMakeLists.txt")
            continue
        for number, line in enumerate((ROOT / file).read_text().splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*(["<])([^">]+)/[^">/]+[">]', line)
            if include and (include[1] == '"' or include[2] in rooms) and include[2] not in {room, *rooms[room]}:
                report(f"{file}:{number}", f"{room} may not use {include[2]}: see its vestige_room call")


def count_files(files, rooms):
    rows = (ROOT / "CONTRIBUTING.md").read_text()
    for room in rooms:
        if f"| `{room}/`" not in rows:
            report("CONTRIBUTING.md", f"has no row for `{room}/`")
    counts = {}
    for file in files:
        folder = str(pathlib.PurePath(file).parent)
        counts[folder] = counts.get(folder, 0) + 1
    for folder, count in sorted(counts.items()):
        if count > MOST_FILES and not folder.startswith(UNCOUNTED):
            report(folder, f"holds {count} files, more than {MOST_FILES}: split it by purpose")


def main():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.splitlines()
    files = [f for f in listed if (ROOT / f).is_file()]
    rooms = rooms_of(files) | ALONE
    refuse_circles(rooms)
    refuse_includes(files, rooms)
    count_files(files, rooms)
    print("\n".join(problems) or f"arrows: {len(rooms)} rooms, and every include goes where it may")
    return 1 if problems else 0


sys.exit(main())
