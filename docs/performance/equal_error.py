#!/usr/bin/env python3
"""Ratios of Embree's time to ours at equal error, from the turns of beside-embree.sh.

  equal_error.py WORK [--json F]

Embree's time is that of the eye pass plus that of as many shadow rays a pixel as
have our error: between two measured counts, log-linear in the error. It leaves out
building its trees and all shading; ours includes shading and counting, and leaves out
or includes what is built of the meshes before the frame. All ways of looking at it are
in the table.
"""
import argparse
import glob
import json
import math
import os
import statistics


def equal(rows, rmse):
    """Rays and milliseconds at which the error is `rmse`; None beyond the range."""
    measured = [r for r in rows if r['time']]
    if len(measured) == 1:
        return (measured[0]['rays'], measured[0]['time']['median']) if measured[0]['rmse'] <= rmse else None
    a, b = measured
    if b['rmse'] > rmse:
        return None
    share = math.log(a['rmse'] / rmse) / math.log(a['rmse'] / b['rmse'])
    mix = lambda x, y: x + (y - x) * min(1.0, max(0.0, share))
    return mix(a['rays'], b['rays']), mix(a['time']['median'], b['time']['median'])


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument('work')
    ap.add_argument('--json')
    a = ap.parse_args()
    turns = []
    for path in sorted(glob.glob(os.path.join(a.work, 'embree-*.json'))):
        name = os.path.basename(path)[7:-5]
        theirs = json.load(open(path))
        ours = json.load(open(os.path.join(a.work, 'ours-%s.json' % name)))[0]
        found = equal(theirs['rows'], ours['rmse'])
        turns.append(dict(scene=theirs['scene'], ours=ours, theirs=theirs, equal=found))
    print('| scene | RMSE | ours, ms | built in, ms | Embree: rays at equal RMSE | shadow rays, ms | eye rays, ms | shadow rays / ours | eye and shadow rays / ours | the same / ours with building | shadow rays / ours with building |')
    print('| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |')
    for scene in sorted({t['scene'] for t in turns}):
        of = [t for t in turns if t['scene'] == scene]
        if any(t['equal'] is None for t in of):
            print('| %s | %.5f | | | more than 4096 | | | | | | |' % (scene, of[0]['ours']['rmse']))
            continue
        mid = lambda f: statistics.median(f(t) for t in of)
        spread = lambda f: '**%.1f** (%.1f to %.1f)' % (mid(f), min(map(f, of)), max(map(f, of)))
        frame = lambda t: t['ours']['median']
        built = lambda t: t['ours']['build_ms']
        rays = lambda t: t['equal'][1]
        eye = lambda t: t['theirs']['eye']['median']
        cells = ['%.5f' % of[0]['ours']['rmse'], '%.2f' % mid(frame), '%.2f' % mid(built), '%.0f' % mid(lambda t: t['equal'][0]),
                 '%.1f' % mid(rays), '%.1f' % mid(eye), spread(lambda t: rays(t) / frame(t)),
                 spread(lambda t: (rays(t) + eye(t)) / frame(t)), spread(lambda t: (rays(t) + eye(t)) / (frame(t) + built(t))),
                 spread(lambda t: rays(t) / (frame(t) + built(t)))]
        print('| %s | %s |' % (scene, ' | '.join(cells)))
    print()
    biases = {t['scene']: t['theirs']['bias'] for t in turns}
    print('Embree with 4096 rays against the exact visibility: ' + ', '.join('%s %.5f' % b for b in sorted(biases.items())) + '.')
    print('%s, %d threads; ours on %d, %s' % (turns[0]['theirs']['embree'], turns[0]['theirs']['threads'], turns[0]['ours']['threads'],
                                             turns[0]['ours']['technique']))
    if a.json:
        json.dump(turns, open(a.json, 'w'), indent=1)


if __name__ == '__main__':
    main()
