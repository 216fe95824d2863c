"""A small DiffusionNet [SACO22] labels the parts of generated figures: it spreads features by heat, and compares their gradients.

All it uses of a mesh are the operators of `ahm.torch.operators`. The inputs are heat kernel signatures, which do not depend on the
position of a figure. The same network without diffusion and gradients looks at every vertex alone.

    python3 08_diffusion_net.py [--figures N] [--epochs N] [--seed N]
"""

import argparse
import time

import numpy as np
import torch
from figures import PARTS, figure

import ahm.torch

EIGENVECTORS, SIGNATURES, CHANNELS, BLOCKS = 64, 8, 24, 3
SHORTEST, LONGEST = 1.0, 300.0                                        # times of heat, for edges of length 1


def inputs(operators):
    """Heat kernel signatures, (n, SIGNATURES): the heat that is left at a vertex, on a logarithmic scale."""
    times = torch.logspace(np.log10(SHORTEST), np.log10(LONGEST), SIGNATURES)
    left = operators.eigenvectors**2 @ torch.exp(-operators.eigenvalues[:, None] * times)
    found = left.clamp(min=1e-9).log()
    return found - found.mean(0)


class Block(torch.nn.Module):
    """Adds to every channel what a network makes of it, of its diffusion and of the angles between gradients of channels."""

    def __init__(self, diffusion):
        super().__init__()
        self.diffusion = diffusion
        self.log_time = torch.nn.Parameter(torch.linspace(np.log(SHORTEST), np.log(LONGEST), CHANNELS))
        self.turn = torch.nn.Parameter(torch.randn(CHANNELS, CHANNELS, 2) / CHANNELS**0.5)
        width = CHANNELS * (3 if diffusion else 1)
        self.network = torch.nn.Sequential(torch.nn.Linear(width, CHANNELS), torch.nn.ReLU(), torch.nn.Linear(CHANNELS, CHANNELS))

    def forward(self, x, operators):
        if not self.diffusion:
            return x + self.network(x)
        spectrum = operators.eigenvectors.T @ (operators.mass[:, None] * x)
        decay = torch.exp(-operators.eigenvalues[:, None] * self.log_time.exp())
        diffused = operators.eigenvectors @ (decay * spectrum)
        gradient = torch.complex(torch.sparse.mm(operators.grad_x, diffused), torch.sparse.mm(operators.grad_y, diffused))
        angles = torch.tanh((gradient.conj() * (gradient @ torch.view_as_complex(self.turn))).real)
        return x + self.network(torch.cat([x, diffused, angles], 1))


class Network(torch.nn.Module):
    def __init__(self, diffusion):
        super().__init__()
        self.first = torch.nn.Linear(SIGNATURES, CHANNELS)
        self.blocks = torch.nn.ModuleList(Block(diffusion) for _ in range(BLOCKS))
        self.last = torch.nn.Linear(CHANNELS, len(PARTS))

    def forward(self, operators):
        x = self.first(inputs(operators))
        for block in self.blocks:
            x = block(x, operators)
        return self.last(x)


def accuracy(network, training, tests, epochs):
    """Learns from one figure per step. Returns the share of the vertices of the tests that get their part."""
    optimizer = torch.optim.Adam(network.parameters(), lr=0.005)
    for _ in range(epochs):
        for i in torch.randperm(len(training)).tolist():
            operators, label = training[i]
            optimizer.zero_grad()
            torch.nn.functional.cross_entropy(network(operators), label).backward()
            optimizer.step()
    with torch.no_grad():
        return float(torch.cat([network(operators).argmax(1) == label for operators, label in tests]).float().mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--figures", type=int, default=12, help="figures to learn from, and as many others to test")
    parser.add_argument("--epochs", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random, start = np.random.default_rng(options.seed), time.perf_counter()
    figures = [figure(random) for _ in range(2 * options.figures)]
    data = [(ahm.torch.operators(mesh, EIGENVECTORS), torch.from_numpy(label)) for mesh, label in figures]
    labels = torch.cat([label for _, label in data[options.figures :]])
    print(f"{options.figures} figures to learn from; {len(labels)} vertices to test, {100 * (labels == 0).float().mean():.0f} % of them "
          f"{PARTS[0]} (operators: {time.perf_counter() - start:.0f} s)")
    for name in ("diffusion and gradients", "every vertex alone"):
        start = time.perf_counter()
        torch.manual_seed(options.seed)
        right = accuracy(Network(name != "every vertex alone"), data[: options.figures], data[options.figures :], options.epochs)
        print(f"{name}: {100 * right:.1f} % of the vertices are right ({time.perf_counter() - start:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
