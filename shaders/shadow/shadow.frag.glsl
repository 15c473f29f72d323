// SPDX-License-Identifier: Apache-2.0

// ALPHA_TEST  1: light passes through where the base colour's alpha is below the cut-off

layout(location = 3) in vec2 v_uv;

#if ALPHA_TEST
layout(std140, binding = 1) uniform Material {
  vec4 u_base_colour;
  float u_roughness;
  float u_specular;
  float u_alpha_cutoff;
  float u_cavity_albedo;
  float u_thickness;
  vec4 u_texture_uv;
};
layout(binding = 0) uniform sampler2D u_base_colour_map;
#endif

void main() {
#if ALPHA_TEST
  if (u_base_colour.a * texture(u_base_colour_map, v_uv * u_texture_uv.xy + u_texture_uv.zw).a < u_alpha_cutoff) discard;
#endif
}
