#!/usr/bin/env python3
"""Checks the documentation: every *.md file under git. Prints every break as FILE:LINE: WHAT.

1. Every relative link and image leads to something, its #anchor included.
2. README.md has at most 150 lines, and names every verb of the program. docs/README.md leads to every page of docs/.
3. Every command in a fenced block, a line that begins with "$ ", runs with its exit code and with the output below it.

Commands of a page run one after the other in a temporary folder of the page. Output is standard output and standard
error together. In it, any number matches any other, and so do hashes, OpenGL contexts and white space. Lines of progress do not count. "…" matches anything, and
alone on a line any lines. A command without output below it may print what it likes.

HTML comments directly above a block say how it is tested:
  <!-- test: exit 0 3 -->                        the exit codes, one for each command; one alone holds for all
  <!-- test: exact -->                           numbers and hashes must be the same too
  <!-- test: output varies: REASON -->           only the exit codes are compared
  <!-- test: with record --duration 0.2 -->      in this block, `vestige record` gets these flags as well
  <!-- test: given: vestige record -o a.mcap --> a command that runs before the block, without being shown
  <!-- test: file: regions.json -->              the block is a file of this name
  <!-- test: data: motion/cmu_01_01.bvh -->      copies a file of --data into the folder; if there is none, skips the block
  <!-- test: not run: REASON -->                 the block is left out, and counted

Usage: check_docs.py [--bin FOLDER] [--data FOLDER] [PAGE...]
"""
import argparse
import collections
import concurrent.futures
import difflib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_README_LINES = 150
PATIENCE_S = 120
PROGRESS = re.compile(r"vestige: [^:]+: \d+ %(, about \d+ s left)?")  # which only a slow machine prints

Block = collections.namedtuple("Block", "line lines notes")  # line: of the first of `lines`
Command = collections.namedtuple("Command", "line text output")


def pages_of(root):
    tracked = subprocess.run(["git", "ls-files", "*.md"], cwd=root, check=True, capture_output=True, text=True).stdout
    return [root / name for name in tracked.splitlines() if (root / name).exists()]


def parse(text):
    """The fenced blocks of a page, and its lines outside of them as (number, line)."""
    blocks, prose, notes, fence = [], [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        if fence is not None:
            if line.strip() == "```":
                blocks.append(fence)
                fence = None
            else:
                fence.lines.append(line)
        elif line.startswith("```"):
            fence, notes = Block(number + 1, [], notes), []
        elif note := re.fullmatch(r"<!-- test: (.*) -->", line):
            notes.append(note[1])
        else:
            notes = []
            prose.append((number, line))
    return blocks, prose


def commands_of(block):
    commands, more = [], False
    for number, line in enumerate(block.lines, block.line):
        if more:
            commands[-1] = commands[-1]._replace(text=commands[-1].text + "\n" + line)
        elif line.startswith("$ "):
            commands.append(Command(number, line[2:], []))
        elif commands:
            commands[-1].output.append(line)
        more = line.endswith("\\") and (more or line.startswith("$ "))
    return commands


def anchors_of(path):
    """As GitHub makes them of headings."""
    seen, anchors = collections.Counter(), set()
    for _, line in parse(path.read_text())[1]:
        if heading := re.match(r"#+ +(.*)", line):
            text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
            anchor = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
            anchors.add(f"{anchor}-{seen[anchor]}" if seen[anchor] else anchor)
            seen[anchor] += 1
    return anchors


def links_of(page):
    for number, line in parse(page.read_text())[1]:
        for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if not re.match(r"[a-z]+:", link):
                yield number, link


def check_links(page, report):
    for number, link in links_of(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists():
            report(page, number, f"{link} leads to nothing")
        elif anchor and target.suffix == ".md" and anchor not in anchors_of(target):
            report(page, number, f"{path or page.name} has no heading #{anchor}")


def check_readme(environment, report):
    readme = ROOT / "README.md"
    lines = readme.read_text().splitlines()
    if len(lines) > MOST_README_LINES:
        report(readme, len(lines), f"{len(lines)} lines are more than {MOST_README_LINES}: move some of it to docs/")
    help_text = subprocess.run(["vestige", "--help"], env=environment, capture_output=True, text=True).stdout
    rows = "\n".join(line for line in lines if line.startswith("| "))
    for verb in re.findall(r"^  ([a-z]+)  +\S", help_text.partition("Options:")[0], re.M):
        if not re.search(rf"`{verb}\b", rows):
            report(readme, 1, f"no table has the verb `{verb}`")


def check_index(report):
    index = ROOT / "docs/README.md"
    linked = {(index.parent / link.partition("#")[0]).resolve() for _, link in links_of(index)}
    for page in sorted((ROOT / "docs").rglob("*.md")):
        if page != index and page not in linked and page.parent.name != "reference":
            report(index, 1, f"does not lead to {page.relative_to(ROOT)}")


def loosen(line):
    line = re.sub(r"\b[0-9a-f]{16,}\b", "<hash>", line)
    line = re.sub(r"\b(egl-surfaceless|egl-device-\d+|osmesa) \(.*\)(?=:)", "<context>", line)
    return re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", line)


def tidy(lines, exact):
    """Lines to compare: without progress, ends and runs of white space, and unless `exact` without numbers and hashes."""
    lines = [line for line in lines if not PROGRESS.fullmatch(line)]
    lines = [re.sub(r"\s+", " ", line if exact else loosen(line)).strip() for line in lines]
    return lines[: len(lines) - next((i for i, line in enumerate(reversed(lines)) if line), len(lines))]


def matches(expected, actual):
    pattern = ""
    for line in expected:
        pattern += "(?:.*\n)*?" if line == "…" else re.escape(line).replace("…", ".*") + "\n"
    return re.fullmatch(pattern, "".join(line + "\n" for line in actual)) is not None


def with_flags(command, verb, pairs):
    """`command` with these flags at `vestige verb`; a flag that it has gets the new value."""
    for flag, value in pairs:
        command, replaced = re.subn(rf"(?<=\s){flag}\s+\S+", f"{flag} {value}", command)
        if not replaced:
            command = re.sub(rf"\bvestige {verb}\b", rf"\g<0> {flag} {value}", command)
    return command


def run_page(page, options, environment, report):
    """Runs the commands of a page; returns how many ran, and (line, how many, why) of those left out."""
    ran, left_out = 0, []
    with tempfile.TemporaryDirectory(prefix="vestige-docs-") as folder:
        for block in parse(page.read_text())[0]:
            commands = commands_of(block)
            codes, exact, compares, flags, given, reason = [0], False, True, [], [], None
            for note in block.notes:
                kind, _, rest = note.partition(" ")
                if kind == "exit":
                    codes = [int(code) for code in rest.split()]
                elif kind == "exact":
                    exact = True
                elif note.startswith("output varies: "):
                    compares = False
                elif kind == "with":
                    verb, *pairs = re.split(r" (?=--)", rest)
                    flags.append((verb, [pair.split(maxsplit=1) for pair in pairs]))
                elif kind == "given:":
                    given.append(rest)
                elif kind == "file:":
                    pathlib.Path(folder, rest).write_text("\n".join(block.lines) + "\n")
                elif kind == "data:":
                    source = options.data / rest
                    if source.exists():
                        shutil.copy(source, folder)
                    else:
                        reason = f"{source} IS MISSING"
                elif note.startswith("not run: "):
                    reason = note.removeprefix("not run: ")
                else:
                    report(page, block.line - 2, f"unknown comment 'test: {note}'")
            if reason:
                left_out.append((block.line, len(commands), reason))
                continue
            if len(codes) == 1:
                codes *= max(1, len(commands))
            if commands and len(codes) != len(commands):
                report(page, block.line, f"{len(codes)} exit codes for {len(commands)} commands")
                continue
            hidden = [(Command(block.line - 1, text, []), 0) for text in given]
            for command, code in hidden + list(zip(commands, codes)):
                text = command.text
                for verb, pairs in flags:
                    text = with_flags(text, verb, pairs)
                try:
                    done = subprocess.run(["bash", "-c", text], cwd=folder, env=environment, timeout=PATIENCE_S, text=True,
                                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                except subprocess.TimeoutExpired:
                    report(page, command.line, f"$ {text}\n  ran for more than {PATIENCE_S} s")
                    continue
                ran += 1
                actual = done.stdout.splitlines()
                if done.returncode != code:
                    report(page, command.line, f"$ {text}\n  exit code {done.returncode}, not {code}:\n" +
                           "".join(f"  | {line}\n" for line in actual))
                elif command.output and compares:
                    wanted, got = tidy(command.output, exact), tidy(actual, exact)
                    if not matches(wanted, got):
                        report(page, command.line, f"$ {text}\n  output differs (- the page, + the program):\n" +
                               "".join(f"  {line}\n" for line in list(difflib.unified_diff(wanted, got, lineterm=""))[2:]))
    return ran, left_out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, help="folder of the built programs (default: those of PATH)")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data", help="folder of real data")
    parser.add_argument("pages", nargs="*", type=pathlib.Path, help="only these (default: all)")
    options = parser.parse_args()
    environment = dict(os.environ, NO_COLOR="1", LC_ALL="C.UTF-8")
    if options.bin:
        environment["PATH"] = f"{options.bin.resolve()}:{environment['PATH']}"

    problems = []

    def report(page, line, what):
        problems.append(f"{page.relative_to(ROOT)}:{line}: {what}")

    start = time.monotonic()
    pages = [page.resolve() for page in options.pages] or pages_of(ROOT)[::-1]  # the longest, the tutorial, first
    for page in pages:
        check_links(page, report)
    check_readme(environment, report)
    check_index(report)
    counts = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:  # pages do not share anything
        results = pool.map(lambda page: run_page(page, options, environment, report), pages)
        for page, (ran, left_out) in zip(pages, results):
            counts["run"] += ran
            for line, commands, reason in left_out:
                counts["not run"] += commands
                print(f"{page.relative_to(ROOT)}:{line}: {commands} not run: {reason}")
    print("\n".join(problems))
    print(f"docs: {len(pages)} pages, {counts['run']} commands run, {counts['not run']} not run, "
          f"{len(problems)} problems, {time.monotonic() - start:.1f} s")
    return 1 if problems else 0


sys.exit(main())
