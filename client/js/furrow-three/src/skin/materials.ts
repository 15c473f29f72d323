// SPDX-License-Identifier: Apache-2.0
// Kinds of material, as numbers that the shaders share.

export type Kind = 'skin' | 'cloth' | 'eye' | 'hair' | 'other' | 'shade';

/** In the order of character::Material::Kind. */
export const KINDS: readonly Kind[] = ['skin', 'cloth', 'eye', 'hair', 'other', 'shade'];

export const KIND_DEFINES = Object.fromEntries(KINDS.map((kind, i) => [`MATERIAL_${kind.toUpperCase()}`, i]));

/** MAX_CURVATURE of the shaders. Only preintegrated scattering needs curvatures, which are 0 here. */
export const MAX_CURVATURE = '0.5';
