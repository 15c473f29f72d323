// SPDX-License-Identifier: Apache-2.0
#include "occlusion/occlusion.glsl"

// Ground-truth ambient occlusion (Jimenez, Wu, Pesce and Jarabo 2016). In slices through the view
// direction, it searches for the horizon on both sides and integrates the cosine-weighted sky
// between the horizons. Normals are the scene's, including wrinkles.

const int SLICES = SAMPLES >= 24 ? 3 : 2;
// Rotation from one slice to the next: 90 or 60 degrees.
const mat2 SLICE_TURN = SLICES == 2 ? mat2(0.0, 1.0, -1.0, 0.0) : mat2(0.5, 0.8660254, -0.8660254, 0.5);
const int STEPS = max(SAMPLES / (2 * SLICES), 1);

// acos for x in [-1, 1], within 0.001 rad (Lagarde 2014).
float fastAcos(float x) {
  float a = abs(x);
  float y = (-0.156583 * a + 1.5707963) * sqrt(1.0 - a);
  return x >= 0.0 ? y : PI - y;
}

// Cosine of the horizon on one side. `direction`: in pixels; the farthest step is `reach` pixels
// away; `lowest`: the smallest possible result.
float horizon(vec2 pixel, vec3 centre, vec3 toEye, vec2 direction, float reach, float jitter,
              float lowest, int steps) {
  float highest = lowest;
  for (int i = 0; i < steps; ++i) {
    float t = (float(i) + jitter) / float(STEPS);
    vec2 at = pixel + direction * max(reach * t * t, float(i) + 1.0);
    vec3 to = viewPosition(floor(at) + 0.5, depthAt(at)) - centre;
    float distance2 = max(dot(to, to), 1e-12);
    float cosine = dot(to, toEye) * inversesqrt(distance2);
    // Occluders fade out towards the radius. A surface in front is assumed to be one radius thick,
    // so the distance is measured to the nearest point of its hidden part.
    float front = max(dot(to, toEye), 0.0);
    float excess = max(front - u_reach.x, 0.0);
    float nearest2 = distance2 - front * front + excess * excess;
    float fade = saturate(1.5 - 1.5 * nearest2 / (u_reach.x * u_reach.x));
    highest = max(highest, mix(lowest, cosine, fade));
  }
  return highest;
}

// Cosine-weighted sky between the normal and a horizon at the angle h, both measured from the view
// direction: openArc(h, n) = (-cos(2 h - n) + cos n + 2 h sin n) / 4. `side`: the sign of h;
// `cosH`: cosine of h; `n`: cosine and sine of the normal's angle.
float openArc(float cosH, float side, vec2 n) {
  float h = side * fastAcos(cosH);
  float sinH = side * sqrt(max(1.0 - cosH * cosH, 0.0));
  float cos2h = 2.0 * cosH * cosH - 1.0;
  float sin2h = 2.0 * sinH * cosH;
  return 0.25 * (n.x - cos2h * n.x - sin2h * n.y + 2.0 * h * n.y);
}

void main() {
  ivec2 pixel = scenePixel();
  float metres = depthAt(vec2(pixel));
  vec2 place = vec2(pixel) + 0.5;
  vec3 centre = viewPosition(place, metres);
  vec3 toEye = -normalize(centre);
  vec3 normal = viewNormal(pixel);
  // The search never needs to leave the picture.
  float reach = clamp(u_reach.x * u_lens.x / metres, 2.0, length(2.0 * u_lens.yz));
  float noise = tileNoise();
  // Groups of pixels without a surface skip the loops.
  int steps = metres < NO_SURFACE ? STEPS : 0;
  float sum = 0.0;
  float angle = PI * noise / float(SLICES);
  vec2 direction = vec2(cos(angle), sin(angle));
  for (int slice = 0; slice < SLICES; ++slice) {
    vec3 along = vec3(direction, 0.0);
    vec3 axis = normalizeOrZero(cross(along, toEye));       // normal of the slice's plane
    vec3 tangent = cross(toEye, axis);                      // in the plane, on the side of
                                                            // `direction`
    vec3 projected = normal - axis * dot(normal, axis);
    float weight = length(projected);
    float cosN = saturate(dot(projected, toEye) / max(weight, 1e-6));
    float sinN = sign(dot(projected, tangent)) * sqrt(1.0 - cosN * cosN);
    float jitter = fract(noise * 7.0 + 0.37 * float(slice)) * 0.999 + 0.001;
    // The lowest possible horizon is the surface itself, at a right angle to the normal.
    float right = horizon(place, centre, toEye, direction, reach, jitter, -sinN, steps);
    float left = horizon(place, centre, toEye, -direction, reach, jitter, sinN, steps);
    sum += weight * (openArc(right, 1.0, vec2(cosN, sinN)) + openArc(left, -1.0, vec2(cosN, sinN)));
    direction = SLICE_TURN * direction;
  }
  float open = saturate(sum / float(SLICES));
  f_open = metres < NO_SURFACE ? saturate(1.0 - u_reach.y * (1.0 - open)) : 1.0;
}
