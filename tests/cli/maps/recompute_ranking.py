"""Recomputes a batch's ranking from scores.csv alone: means, ranks, differences, p by a bootstrap-t of its own.

Usage: recompute_ranking.py FOLDER METRIC higher|lower. Prints what differs from ranking.json, and exits with 1 if anything does.
"""
import csv, json, math, random, sys
from collections import defaultdict

folder, metric, better = sys.argv[1:4]
sign = 1 if better == "lower" else -1
values = defaultdict(dict)  # by candidate, then by trace
strata = {}
for row in csv.DictReader(open(f"{folder}/scores.csv")):
    strata[row["trace"]] = row["scenario"]
    if row[metric] != "":
        values[row["map"], row["law"]][row["trace"]] = float(row[metric])
mean = {one: math.fsum(of.values()) / len(of) for one, of in values.items()}
order = sorted(mean, key=lambda one: sign * mean[one])
faults = []


def expect(what, found, right, tolerance=1e-9):
    if found is None or abs(found - right) > tolerance * max(1, abs(right)):
        faults.append(f"{what}: {found}, recomputed {right}")


def standard_error(differences):
    """Of a mean whose strata are fixed."""
    of = defaultdict(list)
    for trace, value in differences:
        of[strata[trace]].append(value)
    variance = 0
    for all in of.values():
        middle = math.fsum(all) / len(all)
        variance += len(all) * math.fsum((one - middle) ** 2 for one in all) / (len(all) - 1)
    return math.sqrt(variance) / len(differences)


ranking = json.load(open(f"{folder}/ranking.json"))
for one in ranking["ranking"]:
    key = one["map"], one["law"]
    if key not in mean:
        continue
    expect(f"mean of {key}", one["headline"]["mean"], mean[key])
    expect(f"rank of {key}", one["rank"], 1 + sum(sign * other < sign * mean[key] for other in mean.values()))
    rival = order[0] if key != order[0] else order[1]
    expect(f"difference of {key}", one["difference_from_best"]["mean"], mean[key] - mean[order[0]])

# The interval of the leader's mean, by a bootstrap-t of its own; it is random, so only about the same.
leader = values[order[0]]
first = ranking["ranking"][0]["headline"]
if first["low"] is not None:
    error = standard_error(list(leader.items()))
    by_stratum = defaultdict(list)
    for trace, value in leader.items():
        by_stratum[strata[trace]].append((trace, value))
    random.seed(1)
    studentized = []
    while len(studentized) < 4000:
        drawn = [one for all in by_stratum.values() for one in random.choices(all, k=len(all))]
        if (error_drawn := standard_error(drawn)) > 0:
            studentized.append((math.fsum(value for _, value in drawn) / len(drawn) - mean[order[0]]) / error_drawn)
    studentized.sort()
    at = lambda share: studentized[int(share * len(studentized))]
    width = first["high"] - first["low"]
    expect("low", first["low"], mean[order[0]] - at(0.975) * error, 0.15 * width / max(1, abs(first["low"])))
    expect("high", first["high"], mean[order[0]] - at(0.025) * error, 0.15 * width / max(1, abs(first["high"])))
print("\n".join(faults) or f"{len(mean)} candidates agree")
sys.exit(1 if faults else 0)
