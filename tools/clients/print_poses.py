#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints ten poses of lilod: print_poses.py [HOST [PORT]]"""
import sys

from lilo_client import LiloClient

host = sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1"
port = int(sys.argv[2]) if len(sys.argv) > 2 else 9871
count = 0
with LiloClient(host, port) as client:
    for pose in client.poses(timeout_s=10):
        p = pose["position"]
        print(f'{pose["seq"]} {pose["status"]} {p["x"]:.3f} {p["y"]:.3f} {p["z"]:.3f}', flush=True)
        count += 1
        if count == 10:
            break
    else:
        sys.exit(client.why)
