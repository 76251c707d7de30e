"""Command lines of the scripts here: those that draw families, and those that hold slipfit's answers against the truth."""
import argparse
import concurrent.futures
import json
import pathlib


def _parser(description):
    return argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def drawing(description, families, count):
    """Where to, how many of each, which families."""
    parser = _parser(description)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default=",".join(families))
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    tasks = [(family, seed) for family in arguments.only.split(",") for seed in range(arguments.seed, arguments.seed + arguments.count)]
    return arguments, tasks


def evaluated(description, analysed):
    """Arguments, the truths in FOLDER/truth.jsonl, and analysed(slipfit, folder, truth) of each."""
    parser = _parser(description)
    parser.add_argument("slipfit")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--misses", action="store_true", help="name what went wrong")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="families, comma-separated")
    arguments = parser.parse_args()
    truths = [json.loads(text) for text in open(arguments.folder / "truth.jsonl", encoding="utf-8")]
    truths = [t for t in truths if not arguments.only or t["family"] in arguments.only.split(",")]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        return arguments, truths, list(pool.map(lambda t: analysed(arguments.slipfit, arguments.folder, t), truths))
