// SPDX-License-Identifier: Apache-2.0
#include "occlusion/occlusion.glsl"

// Screen-space ambient occlusion (Mittring 2007) as in the thesis: the share of points in a sphere
// around the surface that the camera sees in front of other surfaces. On a flat surface half of the
// points are hidden, which counts as open. Normals are not used.

// The k-th of SAMPLES points, distributed evenly in the unit ball. `turn`: rotation, [0, 1).
vec3 ballPoint(int k, float turn) {
  float z = 1.0 - 2.0 * (float(k) + 0.5) / float(SAMPLES);
  float angle = 2.39996323 * float(k) + 2.0 * PI * turn;
  float radius = pow(fract(float(k) * 0.61803399 + turn), 1.0 / 3.0);
  return radius * vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);
}

void main() {
  ivec2 pixel = scenePixel();
  float metres = depthAt(vec2(pixel));
  vec3 centre = viewPosition(vec2(pixel) + 0.5, metres);
  float noise = tileNoise();
  int samples = metres < NO_SURFACE ? SAMPLES : 0;
  float visible = 0.0;
  for (int k = 0; k < samples; ++k) {
    vec3 point = centre + u_reach.x * ballPoint(k, noise);
    vec2 at = u_lens.yz + point.xy / -point.z * u_lens.x;
    float surface = depthAt(at);
    // A surface nearer to the camera than the whole sphere does not occlude this point.
    bool apart = surface < -point.z - 2.0 * u_reach.x;
    visible += surface >= -point.z || apart ? 1.0 : 0.0;
  }
  float open = saturate(2.0 * visible / float(SAMPLES));
  f_open = metres < NO_SURFACE ? saturate(1.0 - u_reach.y * (1.0 - open)) : 1.0;
}
