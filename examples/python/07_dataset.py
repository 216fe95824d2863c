"""Local maps of every mesh of a folder, prepared once: a pre_transform with a cache on disk, several processes and a progress bar.

The second run reads the cache. With PyTorch Geometric, pass the same transform to a data set: `pre_transform=ahm.torch.LocalMaps(...)`.

    python3 07_dataset.py [FOLDER] [--cache FOLDER] [-k N] [--processes N]
"""

import argparse
import functools
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import torch

import ahm
import ahm.potpourri3d as pp3d
import ahm.torch

try:
    from tqdm import tqdm
except ImportError:

    def tqdm(items, total):
        """One line that is overwritten, where tqdm is not installed."""
        for count, item in enumerate(items, start=1):
            print(f"\r{count} of {total} meshes", end="" if count < total else "\n", flush=True)
            yield item


def prepare(transform, path):
    """The mesh of a file as PyTorch Geometric's Data has it, with local maps, and the file it comes from."""
    V, F = pp3d.read_mesh(str(path))
    return transform(SimpleNamespace(path=path, pos=torch.from_numpy(V).float(), face=torch.from_numpy(F.astype(np.int64).T)))


def write_meshes(folder, count):
    """Stretched balls, where no folder is passed."""
    V, F = ahm.shapes.sphere(4)
    for i in range(count):
        pp3d.write_mesh(V * [1, 1, 1 + 0.1 * i], F, str(folder / f"{i}.ply"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", help="a folder of .ply, .obj, .off or .stl files; without it, generated meshes")
    parser.add_argument("--cache", type=Path, help="folder of the cache; without it, one that is deleted at the end")
    parser.add_argument("-k", type=int, default=32)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or Path(temporary)
        if options.folder is None:
            write_meshes(folder, 12)
        paths = sorted(path for path in folder.iterdir() if path.suffix in (".ply", ".obj", ".off", ".stl"))
        transform = ahm.torch.LocalMaps(k=options.k, threads=1, cache=options.cache or Path(temporary) / "cache")
        for run in ("first", "second"):
            start = time.perf_counter()
            with ProcessPoolExecutor(options.processes) as pool:
                data = list(tqdm(pool.map(functools.partial(prepare, transform), paths), total=len(paths)))
            print(f"{run} run: {time.perf_counter() - start:.2f} s")
    edges = sum(one.edge_index.shape[1] for one in data)
    print(f"{len(data)} meshes, {sum(len(one.pos) for one in data)} vertices, {edges} edges")


if __name__ == "__main__":
    main()
