#!/usr/bin/env python3
"""Turns the measurements of beside-peers.sh into ratios against the targets.

  ratios.py FOLDER [--json FILE]     Markdown on stdout

FOLDER holds, as beside-peers.sh writes them, {peer,ours}-{fill,volumes}-
{one,all}-ROUND.json, peer-blended-*, {counted,uncounted}-{fill,volumes}-ROUND,
scenes.json and some text. Every time is the median over the rounds of each
round's median; behind a ratio stand the smallest and largest of the single
rounds. Counts and digests that differ between the programs are listed. Only
Python's own library is needed.
"""
import argparse
import json
import os
import platform
import re
import statistics
import time
from pathlib import Path

FILL_TARGETS = {'stencil_zfail': 5.0, 'stencil_zpass': 5.0, 'depth_fail': 8.0, 'shader60_add': 4.0}
SMALL_TARGET, FRAME_TARGET, PASS_TARGET = 3.0, 4.0, 5.0
SCALING_TARGET, COUNTING_TARGET = 0.8, 1.05
THREADS = {'one': 'one thread', 'all': 'all cores'}


def load(path):
    return json.loads(path.read_text())


def fill_rows(rows):
    """(case, mesh) -> dict(ms, fragments, triangles)"""
    return {(r['case'], r['mesh']): dict(ms=r['ms'] if 'ms' in r else r['time']['median'],
                                         fragments=r['fragments'], triangles=r['triangles']) for r in rows}


def volume_rows(rows):
    """(scene, size, 'frame' or 'volume') -> dict(ms, and the counts)"""
    kept = ('fragments', 'depth_fail', 'shadowed_pixels', 'stencil_max')
    counts = dict(frame=(), volume=kept)
    return {(r['scene'], r['size'], part): dict({k: r[k] for k in counts[part]}, ms=r[part]['median'])
            for r in rows for part in counts}


class Series:
    """All rounds of one program, one kind of measurement."""

    def __init__(self, folder, pattern, parse):
        self.rounds = []
        for path in sorted(folder.glob(pattern)):
            self.rounds.append(parse(load(path)))

    def merge(self, other):
        for mine, theirs in zip(self.rounds, other.rounds):
            mine.update(theirs)
        return self

    def keys(self):
        return list(self.rounds[0]) if self.rounds else []

    def times(self, key):
        return [r[key]['ms'] for r in self.rounds if key in r]

    def ms(self, key):
        return statistics.median(self.times(key))

    def counts(self, key):
        return {k: v for k, v in self.rounds[0][key].items() if k != 'ms'}


def ratio(slow, fast, key):
    """How many times longer `slow` takes, with the range over rounds."""
    single = [a / b for a, b in zip(slow.times(key), fast.times(key))]
    return dict(ratio=slow.ms(key) / fast.ms(key), lowest=min(single), highest=max(single))


def verdict(value, target, smaller_is_better=False):
    if target is None:
        return ''
    met = value <= target if smaller_is_better else value >= target
    return 'met' if met else 'MISSED'


class Report:
    def __init__(self, folder):
        self.folder, self.lines = folder, []
        self.data = dict(ratios=[], scaling=[], counting=[], differences=[])
        self.ours, self.peer = {}, {}
        for t in THREADS:
            self.peer['fill', t] = Series(folder, f'peer-fill-{t}-*.json', fill_rows).merge(
                Series(folder, f'peer-blended-{t}-*.json', fill_rows))
            self.ours['fill', t] = Series(folder, f'ours-fill-{t}-*.json', fill_rows)
            self.peer['volumes', t] = Series(folder, f'peer-volumes-{t}-*.json', volume_rows)
            self.ours['volumes', t] = Series(folder, f'ours-volumes-{t}-*.json', volume_rows)

    def put(self, *lines):
        self.lines.extend(lines)

    def text(self, name):
        path = self.folder / name
        return path.read_text().strip() if path.exists() else ''

    def head(self):
        model = re.search(r'model name\s*: (.*)', Path('/proc/cpuinfo').read_text())
        facts = dict(date=time.strftime('%Y-%m-%d'), commit=self.text('commit.txt'),
                     machine='%s, %d cores' % (model.group(1) if model else platform.machine(), os.cpu_count()),
                     peer=self.text('peer.txt').split(' | threads')[0], ours=self.text('ours.txt').split(' | threads')[0],
                     rounds=len(self.ours['fill', 'one'].rounds or self.ours['fill', 'all'].rounds))
        self.data.update(facts)
        self.put(*['* %s: %s' % f for f in facts.items()], '')

    def ratios(self, kind, title, columns, describe):
        for t, words in THREADS.items():
            peer, ours = self.peer[kind, t], self.ours[kind, t]
            keys = [k for k in peer.keys() if ours.rounds and k in ours.rounds[0]]
            if not keys:
                continue
            self.put('### %s, %s' % (title, words), '',
                     '| %s | llvmpipe | gnomon | ratio | over rounds | target | |' % columns,
                     '| --- | --- |' + ' ---: |' * 5 + ' --- |')
            for key in keys:
                name, target, shown = describe(key)
                r = ratio(peer, ours, key)
                met = verdict(r['ratio'], target)
                self.data['ratios'].append(dict(r, what=list(key), threads=t, target=target,
                                                peer_ms=peer.ms(key), our_ms=ours.ms(key)))
                self.put('| %s | %s | %s | %.2f | %.2f to %.2f | %s | %s |' % (
                    name, shown(peer, key), shown(ours, key), r['ratio'], r['lowest'], r['highest'],
                    '' if target is None else '%g' % target, met))
                if peer.counts(key) != ours.counts(key):
                    self.differs(name.replace(' | ', ' '), peer.counts(key), ours.counts(key))
            self.put('')

    def differs(self, where, peer, ours):
        unequal = ['%s %s | %s' % (k, peer[k], ours.get(k)) for k in peer if peer[k] != ours.get(k)]
        line = '%s (llvmpipe | gnomon): %s' % (where, ', '.join(unequal))
        if line not in self.data['differences']:
            self.data['differences'].append(line)

    def digests(self):
        peers = load(self.folder / 'scenes.json')
        for path in self.folder.glob('ours-volumes-*.json'):
            for row in load(path):
                scene = peers[row['scene']]
                theirs = [scene[m]['sha256_16'] for m in ('receiver', 'caster', 'volume')]
                if theirs != row['digests']:
                    self.differs('scene %s' % row['scene'], dict(digests=theirs), dict(digests=row['digests']))

    def differences(self):
        self.digests()
        self.put('### Counts and digests that differ', '')
        lines = self.data['differences']
        self.put(*(['* ' + line for line in lines] or [
            'None: triangles, fragments, depth failures, shadowed pixels and digests are equal.']), '')

    def scaling(self):
        cores, rows = os.cpu_count(), []
        for kind in ('volumes', 'fill'):
            one, many = self.ours[kind, 'one'], self.ours[kind, 'all']
            for key in one.keys() if many.rounds else []:
                # Large frames: 1024 x 1024 pixels; the fill cases are no frames.
                target = SCALING_TARGET if key[1:] == (1024, 'frame') else None
                r = ratio(one, many, key)
                name = ' '.join(str(k) for k in key)
                rows.append((name, one.ms(key), many.ms(key), r['ratio'], r['ratio'] / cores, target))
        if not rows:
            return
        self.put('### From 1 thread to %d' % cores, '',
                 '| | 1 thread, ms | %d threads, ms | times | of linear | target | |' % cores,
                 '| --- |' + ' ---: |' * 6)
        for name, one, many, times, share, target in rows:
            self.data['scaling'].append(dict(what=name, one_ms=one, all_ms=many, times=times, of_linear=share))
            self.put('| %s | %.3f | %.3f | %.2f | %.2f | %s | %s |' % (
                name, one, many, times, share, target or '', verdict(share, target)))
        self.put('')

    def counting(self):
        rows = []
        for kind, parse in (('volumes', volume_rows), ('fill', fill_rows)):
            counted = Series(self.folder, f'counted-{kind}-*.json', parse)
            uncounted = Series(self.folder, f'uncounted-{kind}-*.json', parse)
            for key in counted.keys() if uncounted.rounds else []:
                r = ratio(counted, uncounted, key)
                rows.append(dict(r, what=' '.join(str(k) for k in key),
                                 counted_ms=counted.ms(key), uncounted_ms=uncounted.ms(key)))
        if not rows:
            return
        self.data['counting'] = rows
        self.put('### Counting, one thread', '', '| | counted, ms | uncounted, ms | overhead | over rounds | |',
                 '| --- |' + ' ---: |' * 5)
        for r in rows:
            self.put('| %s | %.3f | %.3f | %+.1f%% | %+.1f%% to %+.1f%% | %s |' % (
                r['what'], r['counted_ms'], r['uncounted_ms'], *(100 * (r[k] - 1) for k in ('ratio', 'lowest', 'highest')),
                verdict(r['ratio'], COUNTING_TARGET, True)))
        middle = statistics.median(r['ratio'] for r in rows)
        self.put('| median of all | | | %+.1f%% | | %s |' % (100 * (middle - 1), verdict(middle, COUNTING_TARGET, True)), '')

    def summary(self):
        bound = [r for r in self.data['ratios'] if r['target']]
        missed = [r for r in bound if r['ratio'] < r['target']]
        self.put('%d of %d ratios reach their target.' % (len(bound) - len(missed), len(bound)))
        for r in missed:
            self.put('* %s, %s: %.2f of %g' % (' '.join(str(k) for k in r['what']), THREADS[r['threads']], r['ratio'], r['target']))
        self.put('', 'Load of the machine (1, 5, 15 minutes) while measuring:', '', '```text', self.text('notes.txt'), '```')


def describe_fill(key):
    case, mesh = key
    target = SMALL_TARGET if mesh == 'small' else FILL_TARGETS.get(case)
    unit = 'fragments' if mesh == 'large' else 'triangles'

    def shown(series, key):
        return '%.1f M%s/s' % (series.counts(key)[unit] / series.ms(key) / 1e3, unit[:4] if unit == 'fragments' else 'tri')
    return '%s | %s' % (case, mesh), target, shown


def describe_volumes(key):
    scene, size, part = key
    target = FRAME_TARGET if part == 'frame' else PASS_TARGET
    name = 'whole frame' if part == 'frame' else 'stencil pass'
    return '%s, %d | %s' % (scene, size, name), target, lambda s, k: '%.3f ms' % s.ms(k)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('folder', type=Path)
    parser.add_argument('--json', type=Path)
    options = parser.parse_args()
    report = Report(options.folder)
    report.head()
    report.ratios('volumes', 'Hard shadow volumes', 'scene | what', describe_volumes)
    report.ratios('fill', 'Fill rate', 'case | triangles', describe_fill)
    report.differences()
    report.scaling()
    report.counting()
    report.summary()
    print('\n'.join(report.lines))
    if options.json:
        options.json.write_text(json.dumps(report.data, indent=1) + '\n')


if __name__ == '__main__':
    main()
