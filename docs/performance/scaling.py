#!/usr/bin/env python3
"""Scaling of frames and of their passes over threads, from the turns of convolution.sh.

  scaling.py WORK

reads WORK/scaling-SET-THREADS-ROUND.json. A time is the shortest of all samples, for
other programs only ever add to it; scaling is the time on one thread over that on n,
over n.
"""
import collections
import glob
import json
import os
import sys


def main():
    folder = sys.argv[1]
    least = collections.defaultdict(lambda: float('inf'))
    keys = []
    for path in sorted(glob.glob(os.path.join(folder, 'scaling-*.json'))):
        settings, threads, _ = os.path.basename(path)[8:-5].rsplit('-', 2)
        for row in json.load(open(path)):
            key = (settings, row['scene'])
            if key not in keys:
                keys.append(key)
            at = key + (int(threads),)
            least[at] = min(least[at], row['min'])
    counts = sorted({at[2] for at in least})
    print('| settings | scene | ' + ' | '.join('%d thread%s, ms' % (n, 's' * (n > 1)) for n in counts)
          + ' | ' + ' | '.join('scaling to %d' % n for n in counts[1:]) + ' |')
    print('| --- ' * (2 * len(counts) + 1) + '|')
    for settings, scene in keys:
        times = [least[settings, scene, n] for n in counts]
        scaling = ['%.2f' % (times[0] * counts[0] / (t * n)) for t, n in zip(times[1:], counts[1:])]
        print('| `%s` | %s | %s |' % (settings, scene, ' | '.join(['%.1f' % t for t in times] + scaling)))


if __name__ == '__main__':
    main()
