// SPDX-License-Identifier: Apache-2.0

// Optical properties of the kinds of material. `kind`: MATERIAL_SKIN, _CLOTH, _EYE, _HAIR or
// _OTHER.

// Reflectance at normal incidence: oily skin, fibres, the tear film, keratin, plastics.
float reflectanceOf(int kind) {
  return kind == MATERIAL_SKIN    ? 0.028
         : kind == MATERIAL_CLOTH ? 0.02
         : kind == MATERIAL_EYE   ? 0.025
         : kind == MATERIAL_HAIR  ? 0.046
                                  : 0.04;
}

// Strength of the sheen.
float sheenOf(int kind) { return kind == MATERIAL_CLOTH ? 0.06 : 0.0; }

// Colour in the view `material`.
vec3 materialColour(int kind) {
  return kind == MATERIAL_SKIN    ? vec3(1.0, 0.0, 0.0)
         : kind == MATERIAL_CLOTH ? vec3(0.0, 0.0, 1.0)
         : kind == MATERIAL_EYE   ? vec3(1.0)
         : kind == MATERIAL_HAIR  ? vec3(0.0, 1.0, 0.0)
                                  : vec3(0.5);
}
