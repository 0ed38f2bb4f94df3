#!/usr/bin/env python3
"""One turn of Embree on one peer scene: time and error for ray counts round ours.

  embree_turn.py PEERS SCENE WORK BUDGET ROUND

reads WORK/ours-SCENE-ROUND.json for the error to reach and
WORK/truth_SCENE_512.f32 for the exact visibility (NaN where nothing is compared),
and writes WORK/embree-SCENE-ROUND.json: eye pass, and time, quartiles and RMSE for
square ray counts from 1 up, until one has a smaller error than ours.
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
    rows = []
    for side in range(1, 65):
        run = lambda: e.run(casters, scene, size, 16, side, 1, g, out)
        run()
        error = (out - truth)[compared]
        rmse = float(np.sqrt((error ** 2).mean()))
        above = rmse > ours['rmse']
        rows.append(dict(rays=side * side, rmse=rmse, time=None, side=side))
        if not above:
            break
    for row in rows[-2:]:
        run = lambda: e.run(casters, scene, size, 16, row['side'], 1, g, out)
        row['time'] = measure(run)
    result = dict(scene=name, embree=e.name(), threads=e.threads, eye=eye, rows=rows, pixels=int(compared.sum()))
    json.dump(result, open(os.path.join(work, 'embree-%s-%s.json' % (name, turn)), 'w'))


if __name__ == '__main__':
    main()
