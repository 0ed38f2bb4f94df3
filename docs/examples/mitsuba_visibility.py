#!/usr/bin/env python3
"""Visibility of a Gnomon scene by Mitsuba 3, to be held against Gnomon's.

    gnomon export SCENE --out-dir DIR
    python mitsuba_visibility.py DIR/SCENE.json mine.npy --size 160x120 --rays 256
    gnomon compare SCENE --size 160x120 --against mine.npy

Reads the camera, the first light (a rectangle) and the meshes
that `gnomon export` wrote; nothing of Gnomon's own code. Eye rays go through
pixel centres; from what they hit, N stratified shadow rays go to the light.
The result is the visible share of the light per pixel, 1 where nothing is hit
and where the surface faces away: as float32 rows from the top.
"""
import argparse
import json
import os

import numpy as np


def visible(mi, dr, scene, hit, target):
    """Whether nothing lies between hits and the points of the light."""
    ray = hit.spawn_ray_to(target)
    return ~scene.ray_test(ray)


def points(mi, shape, u, v):
    """Points of the light for numbers in the unit square."""
    (kind, s), = shape.items()
    if kind == 'rectangle':
        c, a, b = (mi.Vector3f(*(float(x) for x in s[k])) for k in ('centre', 'edge-u', 'edge-v'))
        return c + a * (u - 0.5) + b * (v - 0.5)
    raise SystemExit('lights of shape %s are left to the reader' % kind)


def main():
    ap = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    ap.add_argument('json')
    ap.add_argument('out')
    ap.add_argument('--size', default='160x120')
    ap.add_argument('--rays', type=int, default=256, help='a square number')
    ap.add_argument('--variant', default='llvm_ad_rgb')
    a = ap.parse_args()
    import drjit as dr
    import mitsuba as mi
    mi.set_variant(a.variant)
    with open(a.json) as f:
        doc = json.load(f)
    folder = os.path.dirname(os.path.abspath(a.json))
    width, height = (int(n) for n in a.size.split('x'))

    def load(wanted):
        found = {'type': 'scene'}
        for number, o in enumerate(doc['objects']):
            if wanted(o):
                found['object%d' % number] = {
                    'type': 'obj', 'filename': os.path.join(folder, o['mesh']['obj']),
                    'face_normals': True}
        return mi.load_dict(found)

    seen, casters = load(lambda o: True), load(lambda o: o['casts'])

    camera = doc['camera']
    eye = np.array(camera['eye'])
    forward = np.array(camera['target']) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera['up'])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    half = np.tan(np.radians(camera['fov']) / 2)
    x = (2 * (np.arange(width) + 0.5) / width - 1) * half * width / height
    y = (1 - 2 * (np.arange(height) + 0.5) / height) * half
    d = (forward + x[None, :, None] * right + y[:, None, None] * up).reshape(-1, 3)
    d /= np.linalg.norm(d, axis=1, keepdims=True)

    origin = mi.Point3f(*(float(c) for c in eye))
    ray = mi.Ray3f(origin, mi.Vector3f(*(mi.Float(c.astype(np.float32)) for c in d.T)))
    hit = seen.ray_intersect(ray)
    side = int(round(a.rays ** 0.5))
    random = mi.PCG32(size=width * height, initstate=1)
    total = dr.zeros(mi.Float, width * height)
    light = doc['lights'][0]['shape']
    for i in range(side):
        for j in range(side):
            u = (i + random.next_float32()) / side
            v = (j + random.next_float32()) / side
            total += dr.select(visible(mi, dr, casters, hit, points(mi, light, u, v)), 1.0, 0.0)
            dr.eval(total, random)
    # Visibility is of surfaces that the eye sees; a surface that faces away from the
    # light is dark by its own shading, not by a shadow.
    share = dr.select(hit.is_valid(), total / (side * side), 1.0)
    np.save(a.out, np.array(share, dtype=np.float32).reshape(height, width))
    print('wrote %s: %d hits of %d, mean %.5f' % (
        a.out, int(np.count_nonzero(np.array(hit.is_valid()))), width * height,
        float(np.array(share).mean())))


if __name__ == '__main__':
    main()
