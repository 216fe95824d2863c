"""A small harmonic surface network [WEH20] labels the parts of generated figures: on log maps, and on patches without them.

Features are complex numbers: order 0 is a scalar, order 1 a tangent vector u + iv. A filter is a radial profile times e^(i m angle).
Vectors of the neighbors are transported to the frame of the vertex, so results do not depend on the axes of the frames.

    python3 06_segment_shapes.py [--figures N] [--epochs N] [--seed N]
"""

import argparse
import time

import numpy as np
import torch
from figures import PARTS, figure
from scipy.spatial import cKDTree

import ahm
import ahm.torch

ORDERS, RINGS, K, CHANNELS = 2, 3, 32, 8


def patches(mesh, log_maps):
    """K neighbors per vertex, (n, K); their heights over its tangent plane; filters (orders in, n, orders out * rings, K)."""
    frames, points = mesh.frames, mesh.points
    if log_maps:
        edges = ahm.torch.edges(ahm.local_maps(mesh, k=K))
        neighbor = edges.edge_index[0].view(-1, K)
        log, transport = torch.view_as_complex(edges.log).view(-1, K), edges.transport.view(-1, K)
    else:                                                             # projected offsets, and projected axes of the neighbors
        neighbor = torch.from_numpy(cKDTree(points).query(points, K)[1])
        u, v = np.einsum("nad,nkd->ank", frames[:, :2], points[neighbor] - points[:, None])
        x, y = np.einsum("nad,nkd->ank", frames[:, :2], frames[neighbor, 0])
        log = torch.from_numpy(u + 1j * v).cfloat()
        transport = torch.from_numpy((x + 1j * y) / np.maximum(np.hypot(x, y), 1e-9)).cfloat()
    height = torch.from_numpy(np.einsum("nd,nkd->nk", frames[:, 2], points[neighbor] - points[:, None])).cfloat()
    rings = torch.exp(-((log.abs() - 1.5 * torch.arange(RINGS)[:, None, None]) ** 2))
    unit = log / log.abs().clamp(min=1e-9)
    wave, carry = {-1: unit.conj(), 0: torch.ones_like(unit), 1: unit}, (torch.ones_like(unit), transport)
    filters = [torch.stack([ring * wave[to - of] * carry[of] for to in range(ORDERS) for ring in rings], 1) for of in range(ORDERS)]
    return neighbor, height, torch.stack(filters) / K


class Convolution(torch.nn.Module):
    def __init__(self, inputs, outputs):
        super().__init__()
        self.weight = torch.nn.Parameter(torch.randn(ORDERS, ORDERS, RINGS, inputs, outputs, 2) * (2 / inputs) ** 0.5)
        self.bias = torch.nn.Parameter(torch.zeros(ORDERS, 1, outputs))

    def forward(self, near, filters):
        """near : (orders, n, K, inputs) features of the neighbors. Returns (orders, n, outputs)."""
        filtered = (filters @ near).unflatten(2, (ORDERS, RINGS))
        result = torch.einsum("ontrc,otrcd->tnd", filtered, torch.view_as_complex(self.weight))
        size = result.abs()
        return result * (torch.relu(size + self.bias) / (size + 1e-6))


class Network(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.layers = torch.nn.ModuleList(Convolution(inputs, CHANNELS) for inputs in (1, CHANNELS, CHANNELS, CHANNELS))
        self.head = torch.nn.Sequential(torch.nn.Linear(ORDERS * CHANNELS, 32), torch.nn.ReLU(), torch.nn.Linear(32, len(PARTS)))

    def forward(self, neighbor, height, filters):
        near = torch.stack([height, torch.zeros_like(height)])[..., None]
        for layer in self.layers:
            x = layer(near, filters)
            near = x.index_select(1, neighbor.reshape(-1)).view(ORDERS, *neighbor.shape, CHANNELS)
        return self.head(torch.cat(list(x.abs()), 1))


def accuracy(training, tests, epochs):
    """Learns from one figure per step. Returns the share of the vertices of the tests that get their part."""
    network = Network()
    optimizer = torch.optim.Adam(network.parameters(), lr=0.01)
    for _ in range(epochs):
        for i in torch.randperm(len(training)).tolist():
            patch, label = training[i]
            optimizer.zero_grad()
            torch.nn.functional.cross_entropy(network(*patch), label).backward()
            optimizer.step()
    with torch.no_grad():
        return float(torch.cat([network(*patch).argmax(1) == label for patch, label in tests]).float().mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--figures", type=int, default=12, help="figures to learn from, and as many others to test")
    parser.add_argument("--epochs", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    figures = [figure(random) for _ in range(2 * options.figures)]
    labels = np.concatenate([label for _, label in figures[options.figures :]])
    print(f"{options.figures} figures to learn from; {len(labels)} vertices to test, {100 * np.mean(labels == 0):.0f} % of them {PARTS[0]}")
    for name in ("log maps", "nearest neighbors"):
        start = time.perf_counter()
        torch.manual_seed(options.seed)
        data = [(patches(mesh, name == "log maps"), torch.from_numpy(label)) for mesh, label in figures]
        right = accuracy(data[: options.figures], data[options.figures :], options.epochs)
        print(f"{name}: {100 * right:.1f} % of the vertices are right ({time.perf_counter() - start:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
