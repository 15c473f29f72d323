// SPDX-License-Identifier: Apache-2.0
// What skin shading needs of a GPU.
import type { WebGLRenderer } from 'three';

/** Targets of the surface: base colour, two normals, matter, depth, and light that the surface sends out. */
const TARGETS = 6;

/** Why a GPU cannot draw skin shading; empty: it can. */
export function whyNoSkin(renderer: WebGLRenderer): string {
  if (!renderer.extensions.has('EXT_color_buffer_float')) return 'this GPU cannot draw into float targets (EXT_color_buffer_float)';
  const gl = renderer.getContext() as WebGL2RenderingContext;
  const most = gl.getParameter(gl.MAX_DRAW_BUFFERS) as number;
  return most < TARGETS ? `this GPU draws into ${most} targets at once, and skin shading needs ${TARGETS}` : '';
}
