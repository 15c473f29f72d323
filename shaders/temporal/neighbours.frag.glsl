// SPDX-License-Identifier: Apache-2.0
#include "common/texel.glsl"
#include "temporal/ycocg.glsl"

// What accumulate.frag.glsl needs to know of a drawn pixel and its eight neighbours. Rows are those
// of the picture, from the top.

layout(binding = 0) uniform sampler2D u_picture;  // drawn pixels, display-referred
layout(binding = 1) uniform sampler2D u_depth;    // metres along the camera's axis; rows from the
                                                  // bottom, like u_motion
layout(binding = 2) uniform sampler2D u_motion;   // see motionOf() of scene/motion.glsl
#if HAS_FORMER
layout(binding = 3) uniform sampler2D u_former;   // f_place of the former picture
#endif
layout(location = 0) uniform float u_focus;       // metres from the camera to its focus

// xy: from here to the former place, in UV of the picture; z: the share of the former picture that
// may be used, 0 where it showed another surface; w: metres behind the focus.
layout(location = 0) out vec4 f_place;
layout(location = 1) out vec4 f_mean;    // of the nine colours (toYcocg())
layout(location = 2) out vec4 f_spread;  // their standard deviation

const float BEHIND = 1000.0;  // metres; the background, also in half floats
// Depths that differ by less belong to one surface, metres: strands of hair, but not a hand before a
// face.
const float SAME = 0.02;
const float OTHER = 0.05;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_picture, 0) - 1;
  vec3 sum = vec3(0.0);
  vec3 squares = vec3(0.0);
  float nearest = 1e9;
  ivec2 at = pixel;
  // The motion of the nearest surface, so that edges move with what is in front.
  for (int i = 0; i < 9; ++i) {
    ivec2 beside = clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), last);
    vec3 colour = toYcocg(texelFetch(u_picture, beside, 0).rgb);
    sum += colour;
    squares += colour * colour;
    ivec2 flipped = ivec2(beside.x, last.y - beside.y);
    float metres = texelFetch(u_depth, flipped, 0).r;
    at = metres < nearest ? flipped : at;
    nearest = min(nearest, metres);
  }
  vec3 mean = sum / 9.0;
  vec3 motion = texelFetch(u_motion, at, 0).xyz;
  vec2 apart = vec2(0.5, -0.5) * motion.xy;
  float depth = min(nearest - u_focus, BEHIND);
  float trust = 0.0;
#if HAS_FORMER
  vec2 there = (vec2(pixel) + 0.5) / vec2(last + 1) + apart;
  bool inside = all(greaterThanEqual(there, vec2(0.0))) && all(lessThan(there, vec2(1.0)));
  float former = texelInside(u_former, ivec2(there * vec2(textureSize(u_former, 0)))).w;
  float before = min(motion.z, BEHIND);
  trust = inside ? 1.0 - smoothstep(SAME, OTHER, abs(former - before)) : 0.0;
#endif
  f_place = vec4(apart, trust, depth);
  f_mean = vec4(mean, 0.0);
  f_spread = vec4(sqrt(max(squares / 9.0 - mean * mean, vec3(0.0))), 0.0);
}
