#!/usr/bin/python3
"""Runs ours, oneDNN and PyTorch one after the other and prints how they compare (README.md)."""
import argparse
import csv
import io
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
UNET = "U-Net 24-16-32-64-64-3 640x384"


def rows_of(command, environment=None):
    """The CSV that a command prints, as dictionaries; None when it is not there or fails."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True,
                              env={**os.environ, **(environment or {})})
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"left out: {error}", file=sys.stderr)
        return None
    return list(csv.DictReader(io.StringIO(done.stdout)))


def ours(binary, name):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows.csv")
        subprocess.run([binary, "bench", "kernels", "--filter", name, "--csv", path],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        with open(path) as file:
            return {row["name"]: row for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default=os.path.join(ROOT, "build"))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--json")
    options = parser.parse_args()
    program = lambda name: os.path.join(options.build, "bin", name)

    own = {**ours(program("strandlight"), "conv "), **ours(program("strandlight"), UNET)}
    threads = {"OMP_NUM_THREADS": str(options.threads)}
    onednn = rows_of([program("peer_onednn")], threads)
    torch = rows_of(["/usr/bin/python3", os.path.join(ROOT, "tests/peers/torch_unet.py"),
                     "--threads", str(options.threads)], threads)

    table = []
    def add(what, ours_ms, peer, peer_ms):
        table.append({"case": what, "ours_ms": ours_ms, "peer": peer, "peer_ms": peer_ms,
                      "ours_over_peer": ours_ms / peer_ms})
    for name, row in own.items() if onednn else []:
        times = {r["layout"]: float(r["forward_ms"]) for r in onednn if r["name"] == name}
        if times:
            best = min(times, key=times.get)
            add(name, float(row["ms_median"]), f"oneDNN, best layout ({best})", times[best])
            add(name, float(row["ms_median"]), "oneDNN, nchw", times["nchw"])
    forward = float(own[UNET + " forward"]["ms_median"])
    step = float(own[UNET + " training step"]["ms_median"])
    if onednn:
        layers = {}
        for r in onednn:
            if r["name"].startswith("unet "):
                layers.setdefault(r["name"], {})[r["layout"]] = float(r["forward_ms"])
        add(UNET + " forward", forward, "oneDNN, sum of best layouts",
            sum(min(times.values()) for times in layers.values()))
        add(UNET + " forward", forward, "oneDNN, sum of nchw", sum(t["nchw"] for t in layers.values()))
    for r in torch or []:
        add(UNET + " " + r["name"], forward if r["name"] == "forward" else step,
            "PyTorch, " + r["layout"], float(r["ms"]))

    print(f"{'case':48} {'ours ms':>9} {'peer ms':>9} {'ours/peer':>9} {'peer/ours':>9}  peer")
    for t in table:
        print(f"{t['case']:48} {t['ours_ms']:9.2f} {t['peer_ms']:9.2f} {t['ours_over_peer']:9.2f} "
              f"{1 / t['ours_over_peer']:9.2f}  {t['peer']}")
    if options.json:
        with open(options.json, "w") as file:
            json.dump({"rows": table}, file, indent=2)
    return 0


if __name__ == "__main__":
    sys.exit(main())
