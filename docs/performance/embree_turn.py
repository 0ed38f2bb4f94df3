#!/usr/bin/env python3
"""One turn of Embree on one peer scene: time and error for ray counts round ours.

  embree_turn.py PEERS SCENE WORK BUDGET ROUND

reads WORK/ours-SCENE-ROUND.json for the error to reach and
WORK/truth_SCENE_512.f32 for the exact visibility (NaN where nothing is compared),
and writes WORK/embree-SCENE-ROUND.json: eye pass, and RMSE for square ray counts
from 1 up, until one is below ours, with the time of the last two.

Embree's RMSE is against 4096 rays of its own with other random numbers: its noise
alone. Against the exact visibility it has a floor (`bias`) that no ray count gets
below, since its rays start 1e-4 off the surface; it is not held against it.
"""
import json
import os
import sys


def main():
    peers, name, work, budget, turn = sys.argv[1:]
    sys.path.insert(0, peers)
    import numpy as np
    import embree_area_light as peer
    import peerlib
    import scenes

    ours = json.load(open(os.path.join(work, 'ours-%s-%s.json' % (name, turn))))[0]
    size = ours['size']
    truth = np.fromfile(os.path.join(work, 'truth_%s_%d.f32' % (name, size)), np.float32)
    truth = truth.reshape(size, size).astype(np.float64)
    e = peer.Embree()
    scene = scenes.SCENES[name]()
    everything = e.scene([scene.receiver, scene.caster])
    casters = e.scene([scene.caster])
    g, out = e.gbuffer(size), np.zeros((size, size), np.float32)
    measure = lambda f: peerlib.measure(f, 50, float(budget), warmup=1, attempts=1)
    eye = measure(lambda: e.run(everything, scene, size, 0, 1, 0, g, out))
    compared = (g[0][..., 3] > 0) & ~np.isnan(truth)
    reference = np.zeros_like(out)
    e.run(casters, scene, size, 16, 64, 0xC0FFEE, g, reference)
    rmse_of = lambda a, b: float(np.sqrt((((a - b)[compared].astype(np.float64)) ** 2).mean()))
    rows = []
    for side in range(1, 65):
        run = lambda: e.run(casters, scene, size, 16, side, 1, g, out)
        run()
        rmse = rmse_of(out, reference)
        above = rmse > ours['rmse']
        rows.append(dict(rays=side * side, rmse=rmse, time=None, side=side))
        if not above:
            break
    for row in rows[-2:]:
        run = lambda: e.run(casters, scene, size, 16, row['side'], 1, g, out)
        row['time'] = measure(run)
    result = dict(scene=name, embree=e.name(), threads=e.threads, eye=eye, rows=rows, pixels=int(compared.sum()),
                  bias=rmse_of(reference, truth))
    json.dump(result, open(os.path.join(work, 'embree-%s-%s.json' % (name, turn)), 'w'))


if __name__ == '__main__':
    main()
