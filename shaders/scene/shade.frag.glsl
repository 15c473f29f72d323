// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#include "scene/surface_frag.glsl"

// A shell that darkens what the scene's targets already hold: every output is a factor of its
// target (render/passes/scene_draw.cpp blends them so). A factor of 1 changes nothing.
//
// SKIN_TARGETS, FACETS  0, 0: one lit target; 1, 0: those of skin/skin.frag.glsl; 1, 1: those of
//                       scene/surface.frag.glsl

layout(location = 0) out vec4 f_first;   // plain: light; facets: square root of the base colour
#if SKIN_TARGETS
layout(location = 1) out vec4 f_second;  // skin: radiance
layout(location = 2) out vec4 f_third;   // facets: a: share of specular light
layout(location = 3) out vec4 f_fourth;
layout(location = 4) out float f_fifth;
#endif
#if EMISSION_TARGET
layout(location = 5) out vec4 f_sixth;   // facets: emission
#endif
#if MOTION
layout(location = 5 + EMISSION_TARGET) out vec4 f_motion;
#endif

void main() {
  vec3 passes = baseColour().rgb;
#if SKIN_TARGETS
  f_first = FACETS == 1 ? vec4(sqrt(passes), 1.0) : vec4(1.0);
  f_second = FACETS == 1 ? vec4(1.0) : vec4(passes, 1.0);
  f_third = FACETS == 1 ? vec4(vec3(1.0), luminance(passes)) : vec4(1.0);
  f_fourth = vec4(1.0);
  f_fifth = 1.0;
#if EMISSION_TARGET
  f_sixth = vec4(passes, 1.0);
#endif
#if MOTION
  f_motion = vec4(1.0);
#endif
#else
  f_first = vec4(passes, 1.0);
#endif
}
