// SPDX-License-Identifier: Apache-2.0
// The renderer's shaders (shaders/) in the GLSL of WebGL 2. They differ in few words: GLSL ES 3.00 has no bindings and
// locations of uniforms, and three.js sets uniforms one by one instead of in blocks.
import { SHADERS } from '@shaders';

export type Defines = Readonly<Record<string, number | string | boolean>>;

function expand(name: string, included: Set<string>): string {
  if (included.has(name)) return '';
  included.add(name);
  const text = SHADERS[name];
  if (text === undefined) throw new Error(`furrow-three: no shader '${name}'`);
  return text.replace(/^#include "([^"]+)"$/gm, (_, inner: string) => expand(inner, included));
}

function toEs(text: string): string {
  return text
    .replace(/layout\(std140, binding = \d+\) uniform \w+ \{([^}]*)\};/g, (_, members: string) =>
      members.replace(/(\w+ u_\w+(?:\[\w+\])?;)/g, 'uniform $1'))
    .replace(/layout\((?:binding|location) = \d+\) uniform/g, 'uniform');
}

/**
 * A shader or an included file by its path below shaders/, with its includes, without `#version`. A define that is a
 * truth value becomes 0 or 1. `without`: files that the caller brings itself.
 */
export function glslOf(name: string, defines: Defines = {}, without: readonly string[] = []): string {
  const lines = Object.entries(defines).map(([key, value]) => `#define ${key} ${typeof value === 'boolean' ? Number(value) : value}\n`);
  return lines.join('') + toEs(expand(name, new Set(without)));
}

/** Before the text of a whole shader. */
export const PRECISION = 'precision highp float;\nprecision highp int;\nprecision highp sampler2D;\nprecision highp sampler2DShadow;\n';
