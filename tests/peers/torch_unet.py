#!/usr/bin/python3
"""Times the benchmark U-Net of `strandlight bench kernels` in PyTorch: name,layout,milliseconds.

Median of seven forward passes at 640x384, one image, and of five training steps (forward, backward, Adam).
"""
import argparse
import statistics
import sys
import time

import torch
from torch import nn


class UNet(nn.Module):
    """Head 24 -> 16; down 16/32/64/64, 3x3 stride 2; up 64/32/16/16, 4x4 stride 2, [up, skip]; 32 -> 3."""

    def __init__(self):
        super().__init__()
        down, up = [16, 32, 64, 64], [64, 32, 16, 16]
        self.head = nn.Conv2d(24, 16, 3, padding=1)
        skips = [16] + down
        self.down = nn.ModuleList(
            nn.Conv2d(i, o, 3, stride=2, padding=1) for i, o in zip(skips, down))
        inputs = [down[-1]] + [u + s for u, s in zip(up, reversed(skips[:-1]))]
        self.up = nn.ModuleList(
            nn.ConvTranspose2d(i, o, 4, stride=2, padding=1) for i, o in zip(inputs, up))
        self.last = nn.Conv2d(inputs[-1], 3, 3, padding=1)

    def forward(self, x):
        leaky = lambda t: nn.functional.leaky_relu(t, 0.1, inplace=True)
        skips = [leaky(self.head(x))]
        for layer in self.down:
            skips.append(leaky(layer(skips[-1])))
        y = skips.pop()
        for layer in self.up:
            y = torch.cat([leaky(layer(y)), skips.pop()], dim=1)
        return self.last(y)


def median_ms(run, runs):
    run()
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        run()
        times.append((time.perf_counter() - start) * 1e3)
    return statistics.median(times)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--threads", type=int, default=2)
    torch.set_num_threads(parser.parse_args().threads)
    torch.manual_seed(1)
    if "openblas" not in open("/proc/self/maps").read():
        print("warning: PyTorch runs without OpenBLAS (libopenblas0-pthread): no fair peer", file=sys.stderr)
    print("name,layout,ms")
    for layout, memory in (("nhwc", torch.channels_last), ("nchw", torch.contiguous_format)):
        net = UNet().to(memory_format=memory)
        x = torch.rand(1, 24, 384, 640).to(memory_format=memory)
        target = torch.rand(1, 3, 384, 640)
        adam = torch.optim.Adam(net.parameters())

        def forward():
            with torch.no_grad():
                net(x)

        def step():
            adam.zero_grad()
            nn.functional.mse_loss(net(x), target).backward()
            adam.step()

        print(f"forward,{layout},{median_ms(forward, 7):.3f}", flush=True)
        print(f"training step,{layout},{median_ms(step, 5):.3f}", flush=True)


if __name__ == "__main__":
    main()
