"""Measures today's detectors against those of version 0.1.0, frame by frame on equal traces, both in turn.

Those that draw do so on one core, without llvmpipe's pool of threads.

Builds 0.1.0 from its commit, which needs the history of the repository. Needs today's build in build/release.
usage: results/versions.py FOLDER      writes FOLDER/versions.json and FOLDER/versions.txt
"""

import json
import os
import pathlib
import statistics
import subprocess
import sys

COMMIT = '333a0d68be18c32e8ba5e3c01921d7783b497aa1'  # the last one of version 0.1.0
# detector, animation, frames a second, numbers of colliders
CASES = [('cpu', 'idle', 1000, [1, 10, 40, 100, 400, 1000, 100000]), ('cpu', 'idle', 250, [100]), ('cpu', 'idle', 90, [100]),
         ('cpu', 'idle', 60, [100]), ('cpu', 'walk', 1000, [10, 100, 1000]), ('cpu', 'walk', 60, [100]),
         ('geometry', 'idle', 1000, [10, 100, 1000])]
SCENARIOS = ['swarm', 'hug']
TURNS = 7
ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / 'out' / 'versions'
TODAY = ROOT / 'build' / 'release' / 'bin' / 'vestige'


def run(*command, **options):
    subprocess.run([str(word) for word in command], check=True, **options)


def version_0_1_0():
    """Returns its program, built if it is not there yet."""
    source = WORK / 'vestige-0.1.0'
    program = source / 'build' / 'release' / 'bin' / 'vestige'
    if not program.exists():
        source.mkdir(parents=True, exist_ok=True)
        archive = subprocess.run(['git', 'archive', COMMIT], cwd=ROOT, check=True, capture_output=True).stdout
        run('tar', '-x', '-C', source, input=archive)
        run('cmake', '--preset', 'release', cwd=source, stdout=subprocess.DEVNULL)
        run('cmake', '--build', '--preset', 'release', '--target', 'vestige', cwd=source, stdout=subprocess.DEVNULL)
    return program


def measure(program, detector, trace, frames, count):
    """Returns what one turn of a program says of the whole trace: one place, as long as the trace."""
    run(program, 'sweep', trace, '--detector', detector, '--context', 'egl', '--skip', 'on', '--counts', count,
        '--runs', 1, '--run-frames', frames - 1, '--min-time', 0.3, '--no-figure', '--force', '-q', '-o', WORK / 'sweep',
        stderr=subprocess.DEVNULL, env={**os.environ, 'LP_NUM_THREADS': '0'})
    sweep = json.loads((WORK / 'sweep' / 'sweep.json').read_text())
    point = sweep['series'][0]['points'][0]
    return {'sweep': sweep, 'hz': point['hz'], 'texture_hash': point['texture_hash']}


def compare(old, detector, animation, scenario, rate_hz, count):
    trace = WORK / 'trace.mcap'
    duration_s = 0.1 if count > 10000 else 2 if rate_hz == 1000 else 8
    frames = round(duration_s * rate_hz)
    run(TODAY, 'record', '--animation', animation, '--colliders', scenario, '--count', count, '--rate', rate_hz,
        '--duration', duration_s, '--force', '-q', '-o', trace)
    turns = []
    for _ in range(TURNS):
        turn = {version: measure(program, detector, trace, frames, count)
                for version, program in [('before', old), ('today', TODAY)]}
        if turn['before']['texture_hash'] != turn['today']['texture_hash']:
            sys.exit(f'{detector}, {animation}, {scenario}, {count} colliders at {rate_hz} Hz: '
                     'the versions find other contacts')
        turns.append(turn)
    ratios = sorted(turn['today']['hz'] / turn['before']['hz'] for turn in turns)
    return {
        'detector': detector, 'animation': animation, 'scenario': scenario, 'rate_hz': rate_hz, 'colliders': count,
        'frames': frames - 1,
        'texture_hash': turns[0]['today']['texture_hash'],
        'hz_before': statistics.median(turn['before']['hz'] for turn in turns),
        'hz': statistics.median(turn['today']['hz'] for turn in turns),
        'times': statistics.median(ratios), 'times_least': ratios[0], 'times_most': ratios[-1],
    }, turns[-1]['today']['sweep']


def main():
    folder = pathlib.Path(sys.argv[1])
    old = version_0_1_0()
    rows = []
    for detector, animation, rate_hz, counts in CASES:
        for scenario in SCENARIOS:
            for count in counts:
                row, sweep = compare(old, detector, animation, scenario, rate_hz, count)
                rows.append(row)
    table = 'With skipping, one thread, whole traces frame by frame; median of ' \
            f'{TURNS} turns of both versions, least and most in brackets\n\n' \
            'detector  animation  scenario  rate  colliders   0.1.0, Hz   today, Hz   times as fast\n'
    for row in rows:
        table += '{detector:<8}  {animation:<9}  {scenario:<8} {rate_hz:>5} {colliders:>10} {hz_before:>11.0f} ' \
                 '{hz:>11.0f}   {times:.2f} ({times_least:.2f} to {times_most:.2f})\n'.format(**row)
    (folder / 'versions.txt').write_text(table)
    about = {key: sweep[key] for key in ('version', 'commit', 'dirty', 'machine', 'time') if key in sweep}
    about.update({'before': {'version': '0.1.0', 'commit': COMMIT}, 'turns': TURNS, 'points': rows})
    (folder / 'versions.json').write_text(json.dumps(about, indent=2) + '\n')
    print(table, end='')


main()
