#!/usr/bin/env python3
"""Draws DIR/NAME.svg of every DIR/NAME.csv of ahm-bench for which there is a function NAME below: plots.py DIR"""

import csv
import pathlib
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(3)
matplotlib.use("svg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "ahm", "font.size": 9, "axes.grid": True,
                            "grid.color": "#e5e5e5", "axes.axisbelow": True, "axes.titlesize": 10,
                            "axes.spines.top": False, "axes.spines.right": False})
import matplotlib.pyplot as plt

# Okabe and Ito's colors, each with a marker, so that lines can be distinguished without color.
LOOKS = {"AHM_a": ("#0072B2", "o"), "AHM_l": ("#56B4E9", "s"), "VHM_log": ("#D55E00", "^"), "SEM": ("#CC79A7", "v"),
         "DEM": ("#E69F00", "P"), "HM": ("#009E73", "X"), "HM (graph)": ("#009E73", "x"), "SHM": ("#E69F00", "d"),
         "DEM, along the path": ("#D55E00", ">"), "DEM, averaged": ("#CC79A7", "<"), "exact": ("#888888", "."),
         "affine": ("#0072B2", "o"), "vector": ("#D55E00", "^"), "intrinsic Delaunay": ("#0072B2", "o"),
         "as given": ("#D55E00", "^"), "as given, negative weights": ("#888888", "s"), "triangles": ("#000000", "o"),
         "points of the icosphere": ("#888888", "x"), "random points": ("#E69F00", "^"),
         "points on a spiral": ("#CC79A7", "v"), "quads": ("#0072B2", "s"), "quads, refined": ("#0072B2", "s"),
         "hexagons": ("#009E73", "D"), "hexagons, refined": ("#009E73", "D"), "Voronoi cells": ("#D55E00", "P"),
         "Voronoi cells, refined": ("#D55E00", "P"), "distance": ("#0072B2", "o"), "polar": ("#E69F00", "D"),
         "heat": ("#56B4E9", "s"), "heat localized": ("#CC79A7", "v"), "Dijkstra": ("#888888", "+")}
SPARE = [("#0072B2", "o"), ("#D55E00", "^"), ("#009E73", "s"), ("#CC79A7", "v"), ("#E69F00", "D"), ("#56B4E9", "P"),
         ("#000000", "x"), ("#888888", "+")]


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def only(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def values(rows, column):
    """The different words in a column, in their order in the file."""
    return list(dict.fromkeys(row[column] for row in rows))


def look(name, place=0):
    color, marker = LOOKS.get(name, SPARE[place % len(SPARE)])
    line = "--" if "(graph)" in name or "refined" in name else "-"
    return {"color": color, "marker": marker, "markersize": 4, "linewidth": 1.3, "linestyle": line}


def numbers(rows, x, y):
    """The pairs (x, y) of the rows in which both are numbers, sorted."""
    pairs = []
    for row in rows:
        try:
            pairs.append((float(row[x]), float(row[y])))
        except ValueError:
            pass
    return sorted(pairs)


def panels(count, width=3.4, height=2.9, columns=3):
    rows = -(-count // columns)
    columns = min(count, columns)
    figure, axes = plt.subplots(rows, columns, figsize=(width * columns, height * rows), squeeze=False)
    axes = list(axes.flat)
    for axis in axes[count:]:
        axis.remove()
    return figure, axes[:count]


def lines(axis, rows, x, y, by, logx=False, logy=False, title=None, ylabel=None, xlabel=None):
    """Draws one line for each word in the column `by`."""
    for place, name in enumerate(values(rows, by)):
        pairs = numbers(only(rows, **{by: name}), x, y)
        if pairs:
            axis.plot(*zip(*pairs), label=name, **look(name, place))
    axis.set(xlabel=xlabel or x, ylabel=ylabel or y, title=title)
    if logx:
        axis.set_xscale("log")
    if logy:
        axis.set_yscale("log")
        low, high = axis.get_ylim()
        if high < 100 * low:  # otherwise matplotlib writes 1.2 x 10^0
            axis.yaxis.set_major_formatter("{x:g}")
            axis.yaxis.set_minor_formatter("{x:g}" if high < 12 * low else "")


def dots(axis, rows, group, y, by, logy=True, title=None, ylabel=None):
    """Draws a column of marks for each word in the column `group`; marks of different `by` are side by side."""
    groups, names = values(rows, group), values(rows, by)
    for place, name in enumerate(names):
        aside = 0.5 * ((place + 0.5) / len(names) - 0.5)
        chosen = [(groups.index(row[group]) + aside, float(row[y])) for row in only(rows, **{by: name}) if row[y]]
        if chosen:
            axis.plot(*zip(*chosen), label=name, **{**look(name, place), "markersize": 6, "linestyle": "none"})
    axis.set_xticks(range(len(groups)), groups, rotation=25, ha="right")
    axis.set(ylabel=ylabel or y, title=title, xlim=(-0.5, len(groups) - 0.5))
    if logy:
        axis.set_yscale("log")


def legend(figure, axes):
    """Draws one legend for all panels, above them."""
    entries = {}
    for axis in axes:
        for handle, name in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(name, handle)
    figure.tight_layout()
    height = figure.get_size_inches()[1]
    figure.legend(entries.values(), entries.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False,
                  ncol=min(6, len(entries)))
    return figure


def by_shape(rows, x, y, by, column="shape", **options):
    """A figure with one panel for each shape."""
    shapes = values(rows, column)
    figure, axes = panels(len(shapes))
    for axis, shape in zip(axes, shapes):
        lines(axis, only(rows, **{column: shape}), x, y, by, title=shape, **options)
    return legend(figure, axes)


# One function per experiment: from the rows of its table to a figure.

def flat(rows):
    figure, axes = panels(2, width=4.6)
    dots(axes[0], rows, "mesh", "largest / diameter", "method", title="whole plane")
    dots(axes[1], rows, "mesh", "rms near source / h", "method", title="within three edges of the source")
    return legend(figure, axes)


def mazes(rows):
    figure, axes = panels(1, width=5)
    lines(axes[0], rows, "longest path / h", "largest / diameter", "method", logx=True, logy=True,
          xlabel="longest path in the maze / edge length")
    return legend(figure, axes)


def distortion(rows):
    rows = [row for row in rows if row["distance / longest"] != "all"]
    shapes = values(rows, "shape")
    figure, axes = panels(2 * len(shapes), width=2.6, height=2.5, columns=len(shapes))
    for place, shape in enumerate(shapes):
        for axis, column in ((axes[place], "median D"), (axes[len(shapes) + place], "95% D")):
            lines(axis, only(rows, shape=shape), "distance / longest", column, "method", logy=True, title=shape)
    return legend(figure, axes)


def distance(rows):
    return by_shape([row for row in rows if row["distance / longest"] != "all"], "distance / longest", "mean", "method", logy=True, ylabel="mean relative error")


def convergence(rows):
    figure, axes = panels(3)
    chosen = only(rows, mesh="jittered")
    for axis, column in zip(axes, ("L2", "L2 inside", "Linf hemisphere")):
        lines(axis, chosen, "h", column, "method", logx=True, logy=True, xlabel="h, jittered icospheres")
        h = [float(row["h"]) for row in chosen]
        ends = [min(h), max(h)]
        top = max(float(row[column]) for row in chosen)
        axis.plot(ends, [top * end / ends[1] for end in ends], color="#aaaaaa", linestyle=":", label="first order")
    axes[0].set_title("whole sphere")
    axes[1].set_title("within 0.85 pi")
    axes[2].set_title("largest on the hemisphere")
    return legend(figure, axes)


def smooth_surfaces(rows):
    return by_shape(rows, "h", "vector 95%", "method", column="surface", logx=True, logy=True,
                    ylabel="vector error at 95 %, of the distance")


def costs(rows):
    """Time and error of each method on each mesh. Errors below 1e-6 are left out."""
    for row in rows:
        row["us"] = 1e6 * float(row["additional map s"]) / float(row["vertices"])
    figure, axes = panels(2, width=4.4)
    for axis, column, title in zip(axes, ("distance 95%", "vector 95%"), ("distances", "vectors")):
        for place, method in enumerate(values(rows, "method")):
            pairs = [pair for pair in numbers(only(rows, method=method), "us", column) if pair[1] > 1e-6]
            if pairs:
                axis.plot(*zip(*pairs), label=method, **{**look(method, place), "linestyle": "none"})
        axis.set(xlabel="us per vertex and source", ylabel="error at 95 %, of the distance", xscale="log", yscale="log", title=title)
    return legend(figure, axes)


def toolpaths(rows):
    figure, axes = panels(2, width=4.4)
    for axis, column in zip(axes, ("double", "seconds")):
        pairs = numbers(rows, "faces", column)
        axis.plot(*zip(*pairs), "o")
        axis.set(xlabel="faces", ylabel=column, xscale="log")
    return figure


def variants(rows):
    figure, axes = panels(2, width=4.4)
    lines(axes[0], rows, "distance / longest", "median difference", "shape", logy=True, title="all vertices")
    lines(axes[1], rows, "distance / longest", "median difference, kept", "shape", logy=True,
          title="where the quality is above 0.5")
    return legend(figure, axes)


def cut_locus(rows):
    figure, axes = panels(2, width=4.4)
    finest = only(rows, around=values(rows, "around")[-1])
    lines(axes[0], finest, "edges from cut", "mean / radius", "method", logy=True, title="all methods, finest tube")
    lines(axes[1], only(rows, method="AHM_a"), "edges from cut", "mean / radius", "around", logy=True,
          title="AHM_a by edges around the tube")
    axes[1].legend(title="edges around", frameon=False)
    for axis in axes:
        axis.set(xlabel="edges from the cut line", ylabel="mean error / radius")
    handles = axes[0].get_legend_handles_labels()
    figure.tight_layout()
    figure.legend(*handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, ncol=6)
    return figure


def times(rows):
    return by_shape(rows, "t_coef", "distance rms", "method", logx=True, logy=True, ylabel="error of distance")


def delaunay(rows):
    figure, axes = panels(2, width=4.6)
    for axis, method in zip(axes, ("AHM_a", "AHM_l")):
        dots(axis, only(rows, method=method), "mesh", "rms", "triangulation", title=method)
    return legend(figure, axes)


def tessellations(rows):
    figure, axes = panels(2, width=4.8)
    dots(axes[0], [row for row in rows if row["rms"]], "mesh", "rms", "method", title="error of the map")
    dots(axes[1], rows, "mesh", "distance rms", "method", title="error of the distance")
    return legend(figure, axes)


def dem(rows):
    return by_shape(rows, "distance / pi", "mean", "method", column="vertices", logy=True, ylabel="mean error")


def boundary(rows):
    figure, axes = panels(2, width=4.6)
    for axis, part in zip(axes, values(rows, "part")):
        dots(axis, only(rows, part=part), "source", "distance rms", "method", title=part)
    return legend(figure, axes)


def radial(rows):
    figure, axes = panels(len(values(rows, "mesh")))
    for axis, mesh in zip(axes, values(rows, "mesh")):
        lines(axis, only(rows, mesh=mesh, triangulation="as given"), "stretch", "mean angle", "method", logy=True,
              title=mesh + ", as given", ylabel="mean angle, radians")
    return legend(figure, axes)


def trust(rows):
    """The meshes by the 95th percentile of their vector errors."""
    kinds = values(rows, "as")
    figure, axes = panels(len(kinds), width=3.6)
    for axis, kind in zip(axes, kinds):
        chosen = only(rows, **{"as": kind})
        meshes = values(chosen, "mesh")
        for place, method in enumerate(values(chosen, "method")):
            errors = [float(row["vector 95%"]) for row in only(chosen, method=method)]
            axis.plot(sorted(errors), range(1, len(errors) + 1), label=method, **look(method, place))
        axis.set(title=kind, xscale="log", xlabel="vector error at 95 %, of the distance", ylabel="meshes", ylim=(0, len(meshes) + 1))
    return legend(figure, axes)


def discretizations(rows):
    figure, axes = panels(2, width=4.6)
    for axis, variant in zip(axes, ("adaptive", "localized")):
        chosen = [row for row in only(rows, variant=variant, t_coef="1") if "published" not in row["discretization"]]
        lines(axis, chosen, "vertices", "rms", "discretization", logx=True, logy=True, title=variant)
    return legend(figure, axes)


def polygons(rows):
    figure, axes = panels(2, width=4.6)
    for axis, how in zip(axes, ("refined", "polygons")):
        lines(axis, only(rows, discretization=how, variant="adaptive"), "vertices", "rms", "mesh", logx=True,
              logy=True, title=how)
    return legend(figure, axes)


def runtime(rows):
    figure, axes = panels(3, width=3.6)
    methods = ("AHM_a", "AHM_l", "VHM_log")
    for axis, which in zip(axes, ("first", "additional")):
        for method in methods:
            pairs = numbers(rows, "vertices", f"{which} {method} s")
            axis.plot(*zip(*pairs), label=method, **{**look(method), "linestyle": "none"})
        axis.set(title=f"{which} map", ylabel="seconds")
    for column, name in (("build s", "graph"), ("batch of 32 s each", "AHM_a, in a batch of 32")):
        pairs = numbers(rows, "vertices", column)
        axes[column != "build s"].plot(*zip(*pairs), label=name, color="#888888", linestyle="none",
                                       marker="+" if column == "build s" else "x", markersize=4)
    for method in methods:
        pairs = sorted((float(row["vertices"]), float(row[f"first {method} s"]) / float(row[f"additional {method} s"]))
                       for row in rows)
        axes[2].plot(*zip(*pairs), **{**look(method), "linestyle": "none"})
    axes[2].set(title="first / additional", ylabel="times")
    for axis in axes:
        axis.set(xlabel="vertices", xscale="log", yscale="log")
    return legend(figure, axes)


def backends(rows):
    rows = only(rows, part="backend")
    shapes = values(rows, "shape")
    figure, axes = panels(6)
    for axis, shape in zip(axes, shapes):
        lines(axis, only(rows, shape=shape), "vertices", "median error", "as", logx=True, logy=True, title=shape,
              ylabel="median relative error of distance")
    chosen = only(rows, shape="sphere")
    for axis, column, title in zip(axes[3:], ("build s", "first map s", "additional map s"),
                                   ("graph", "first map", "additional map")):
        lines(axis, chosen, "vertices", column, "as", logx=True, logy=True, title=f"sphere: {title}", ylabel="seconds")
    return legend(figure, axes)


def main(folder):
    failed = 0
    for path in sorted(pathlib.Path(folder).glob("*.csv")):
        draw = globals().get(path.stem)
        if draw is None:
            continue
        try:
            figure = draw(read(path))
            figure.savefig(path.with_suffix(".svg"), bbox_inches="tight", metadata={"Date": None})
            plt.close(figure)
        except Exception as error:
            print(f"{path}: {error}", file=sys.stderr)
            failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
