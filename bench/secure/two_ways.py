# SPDX-License-Identifier: Apache-2.0
"""Two ways of sending the same, measured in turn."""
import statistics


def print_table(figures, found):
    """Prints one row per way: the median and the range of each figure.

    `figures`: the titles of the columns by their keys. `found`: by way, a list of runs, each with a number for every key.
    """
    print("| way | " + " | ".join(figures.values()) + " |\n|---|" + "---|" * len(figures))
    for way, runs in found.items():
        cells = []
        for figure in figures:
            values = [run[figure] for run in runs]
            cells.append(f"{statistics.median(values):.1f} ({min(values):.1f} to {max(values):.1f})")
        print(f"| {way} | " + " | ".join(cells) + " |")


def print_ratios(figures, found, way, baseline, keys=("p50", "cpu")):
    """Prints the ratios of the medians of two ways, for some figures of print_table()."""
    for figure in keys:
        ratio = (statistics.median(run[figure] for run in found[way]) /
                 statistics.median(run[figure] for run in found[baseline]))
        print(f"{way} / {baseline}, {figures[figure]}: {ratio:.2f}")
