// SPDX-License-Identifier: Apache-2.0

// The diffusion profile of skin: six Gaussians (d'Eon and Luebke, GPU Gems 3, chapter 14). The
// weights of each channel sum to 1. Mirrors HumanSkin() of render/skin/skin_profile.h.

const int NUM_GAUSSIANS = 6;
const float GAUSSIAN_VARIANCE[NUM_GAUSSIANS] =
    float[](0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41);  // mm^2
const vec3 GAUSSIAN_WEIGHT[NUM_GAUSSIANS] =
    vec3[](vec3(0.233, 0.455, 0.649), vec3(0.100, 0.336, 0.344), vec3(0.118, 0.198, 0.0),
           vec3(0.113, 0.007, 0.007), vec3(0.358, 0.004, 0.0), vec3(0.078, 0.0, 0.0));

// Share of light that passes through `mm` millimetres of skin, [0, 1] (Jimenez 2010): sum of w
// exp(-s^2 / v). GPU Gems 3 has 2 v here, which passes more light.
vec3 transmittance(float mm) {
  vec3 sum = vec3(0.0);
  // 16 bits cannot represent what passes through more than a centimetre, and most of a subject is
  // thicker.
  int terms = mm < 12.0 ? NUM_GAUSSIANS : 0;
  for (int i = 0; i < terms; ++i) {
    sum += GAUSSIAN_WEIGHT[i] * exp(-mm * mm / GAUSSIAN_VARIANCE[i]);
  }
  return sum;
}
