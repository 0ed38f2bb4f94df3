#!/usr/bin/env python3
"""One turn of a peer, run by beside-peers.sh with the peers' Python.

  peer_turn.py PEERS fill|blended|volumes|scenes --json FILE [--threads N] [--budget SECONDS]

PEERS is the folder of the peers' scripts. `fill`, `volumes` and `scenes` are
their gl_fill_rate.py, gl_shadow_volumes.py and scenes.py, unchanged, but that
each set is taken once and without waiting for quiet: beside-peers.sh
alternates the programs many times instead, so that both meet the same
company. `blended` is a case that gl_fill_rate.py has only in halves: its
60-operation shader with the additive blending of its add_rgba8.
"""
import argparse
import json
import sys

parser = argparse.ArgumentParser()
parser.add_argument('peers')
parser.add_argument('what', choices=('fill', 'blended', 'volumes', 'scenes'))
parser.add_argument('--json', required=True)
parser.add_argument('--threads', type=int)
parser.add_argument('--budget', type=float, default=0.5)
options = parser.parse_args()
sys.path.insert(0, options.peers)

import peerlib  # noqa: E402


def measure_once(once, frames=200, budget_s=4.0, before=None, warmup=2, **_):
    return full_measure(once, frames, budget_s, before, warmup, attempts=1)


full_measure = peerlib.measure
peerlib.measure = measure_once
peerlib.wait_quiet = lambda *_, **__: 0.0


def blended():
    import gl_fill_rate as fill
    context, gl = peerlib.gl_context('llvmpipe', options.threads)
    print(peerlib.gl_describe(context))
    peerlib.gl_target(gl, fill.SIZE, fill.SIZE)
    program = peerlib.gl_program(gl, fill.VS, fill.FS_60)
    rows = []
    for name, (vertices, triangles), layers in (
            ('large', fill.grid(1, fill.SIZE), 16), ('small', fill.grid(224, 4.5), 4)):
        gl.glBindVertexArray(gl.glGenVertexArrays(1))
        peerlib.gl_buffer(gl, gl.GL_ARRAY_BUFFER, vertices)
        gl.glEnableVertexAttribArray(0)
        gl.glVertexAttribPointer(0, 2, gl.GL_FLOAT, False, 0, None)
        peerlib.gl_buffer(gl, gl.GL_ELEMENT_ARRAY_BUFFER, triangles)
        gl.glUseProgram(program)
        gl.glUniform4f(gl.glGetUniformLocation(program, 'k'), 0.97, 0.011, 0, 0)

        def draw():
            gl.glDrawElementsInstanced(gl.GL_TRIANGLES, triangles.size, gl.GL_UNSIGNED_INT, None, layers)

        def before():
            gl.glDisable(gl.GL_DEPTH_TEST)
            gl.glDisable(gl.GL_BLEND)
            gl.glClear(gl.GL_COLOR_BUFFER_BIT | gl.GL_DEPTH_BUFFER_BIT | gl.GL_STENCIL_BUFFER_BIT)
            gl.glEnable(gl.GL_BLEND)
            gl.glBlendEquation(gl.GL_FUNC_ADD)
            gl.glBlendFunc(gl.GL_ONE, gl.GL_ONE)
            gl.glFinish()

        def once():
            draw()
            gl.glFinish()

        before()
        fragments = peerlib.gl_samples(gl, draw)
        time = peerlib.measure(once, 100, options.budget, before=before)
        rows.append(dict(case='shader60_add', mesh=name, fragments=fragments,
                         triangles=triangles.size // 3 * layers, time=time))
        print('shader60_add   %-5s %s' % (name, peerlib.show(time)))
    assert gl.glGetError() == 0
    json.dump(rows, open(options.json, 'w'), indent=1)


def main():
    if options.what == 'blended':
        return blended()
    name = dict(fill='gl_fill_rate', volumes='gl_shadow_volumes', scenes='scenes')[options.what]
    sys.argv = [name, '--json', options.json]
    if options.what != 'scenes':
        sys.argv += ['--budget', str(options.budget)]
        sys.argv += [] if options.threads is None else ['--threads', str(options.threads)]
    __import__(name).main()


if __name__ == '__main__':
    main()
