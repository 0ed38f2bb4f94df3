"""Faults of shadow maps, their convolution, and lights fitted to environments."""

SHADERS, PIPELINE = "shaders-rs/src/", "pipeline/src/"

MAPS = ("shadow_maps:: convolution_".split(), "scene::environment".split())

FAULTS = [
    ("sharpening is half as strong", SHADERS + "convolution/visibility.rs",
     "let power = falloff * self.sharpening.strength", "let power = falloff * self.sharpening.strength * if FAULT { 0.5 } else { 1.0 }", MAPS),
    ("bicubic kernels are half a texel off", SHADERS + "shadow_maps.rs",
     "|k| spline(l, receiver.at[k] - 0.5),", "|k| spline(l, receiver.at[k] - if FAULT { 0.0 } else { 0.5 }),", MAPS),
    ("lights of environments are half as wide", PIPELINE + "world/scene/environment/place.rs",
     "edge_u: right * (2.0 * half[0] * reach),", "edge_u: right * (2.0 * half[0] * reach * if FAULT { 0.5 } else { 1.0 }),", MAPS),
]
