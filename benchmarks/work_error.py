# SPDX-License-Identifier: BSD-3-Clause
"""Draws the CSV of build/release/benchmarks/work_error: work_error.py FILE.csv FILE.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

DIGITS = 3e-12   # to which the reference is known


def main(source, target):
    rows = {}
    with open(source, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["method"], []).append((float(row["error_m"]), float(row["seconds"])))
    figure, axes = plt.subplots(figsize=(8, 5.5), layout="constrained")
    for marker, (method, points) in zip("osD^vPX", rows.items()):
        errors, seconds = zip(*points)
        axes.loglog(errors, [1e3 * s for s in seconds], marker=marker, markersize=5, label=method,
                    linestyle="--" if method == "midpoint" else "-")
    best = min(error for points in rows.values() for error, _ in points)
    axes.set_xlim(left=min(best, DIGITS) / 3)
    axes.axvspan(axes.get_xlim()[0], DIGITS, color="0.92", zorder=0)
    axes.annotate("reference's own error", (DIGITS, 1), xycoords=("data", "axes fraction"), xytext=(-3, -4),
                  textcoords="offset points", rotation=90, va="top", ha="right", fontsize=8, color="0.4")
    axes.invert_xaxis()
    axes.set(xlabel="error of the tip at 2 s (m), better to the right", 
             ylabel="time of solve(), one thread (ms)",
             title="Two bricks on ball joints (P16): work against error")
    axes.grid(which="major", alpha=0.4)
    axes.legend()
    figure.savefig(target, dpi=150)
    print(f"wrote {target}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
