// SPDX-License-Identifier: Apache-2.0
#include "skin/scatter.glsl"

// Resolves the scene's samples to one per pixel. Edges stay smooth, and light on skin does not mix
// with other light: the light on skin is the mean over the skin samples only, and its albedo,
// summed over these samples and divided by all, says how much of the pixel they cover. Without skin
// samples the albedo is that of the other samples.
//
// SAMPLES  samples per pixel of the scene's targets, at least 2

layout(binding = 0) uniform sampler2DMS u_irradiance;
layout(binding = 1) uniform sampler2DMS u_radiance;
layout(binding = 2) uniform sampler2DMS u_albedo;
layout(binding = 3) uniform sampler2DMS u_normal;
layout(binding = 4) uniform sampler2DMS u_depth;

layout(location = 0) out vec4 f_irradiance;
layout(location = 1) out vec4 f_radiance;
layout(location = 2) out vec4 f_albedo;
layout(location = 3) out vec4 f_normal;
layout(location = 4) out float f_depth;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 irradiance = vec4(0.0);
  vec4 radiance = vec4(0.0);
  vec4 albedo = vec4(0.0);
  vec3 rest = vec3(0.0);
  vec4 normal = vec4(0.0);
  float skin = 0.0;
  float depth = 1e9;
  for (int i = 0; i < SAMPLES; ++i) {
    vec4 light = texelFetch(u_irradiance, pixel, i);
    vec4 colour = texelFetch(u_albedo, pixel, i);
    radiance += texelFetch(u_radiance, pixel, i);
    if (isSkin(light)) {
      irradiance += light;
      albedo += colour;
      skin += 1.0;
    } else {
      rest += colour.rgb;
    }
    // Keep the nearest sample: a mean depth would lie on no surface.
    float metres = texelFetch(u_depth, pixel, i).r;
    if (metres < depth) {
      depth = metres;
      normal = texelFetch(u_normal, pixel, i);
    }
  }
  f_irradiance = skin > 0.0 ? irradiance / skin : vec4(0.0, 0.0, 0.0, FAR_AWAY);
  f_radiance = radiance / float(SAMPLES);
  f_albedo = skin > 0.0 ? vec4(albedo.rgb / float(SAMPLES), albedo.a / skin)
                        : vec4(rest / float(SAMPLES), 0.0);
  f_normal = normal;
  f_depth = depth;
}
