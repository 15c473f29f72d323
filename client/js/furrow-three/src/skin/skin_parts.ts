// SPDX-License-Identifier: Apache-2.0
// The parts of one character that skin shading needs: uniforms of its facets, and materials that draw it into shadow maps.
import {
  type IUniform, Matrix3, type MeshPhysicalMaterial, NoBlending, ShaderMaterial, type SkinnedMesh, Vector3, Vector4, type WebGLRenderer,
} from 'three';
import { glslOf } from './glsl.js';
import type { Kind } from './materials.js';

const VERTEX = `
#include <common>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
${glslOf('shadow/shadow_view.glsl')}
uniform int u_light;
uniform mat3 furrowUv;
varying vec2 vFurrowUv;
void main() {
  #include <skinbase_vertex>
  #include <begin_vertex>
  #include <morphtarget_vertex>
  #include <skinning_vertex>
  vFurrowUv = (furrowUv * vec3(uv, 1.0)).xy;
  gl_Position = shadowPosition(u_lights[u_light], (modelMatrix * vec4(transformed, 1.0)).xyz);
  // Surfaces nearer to the lamp than the stage cast shadows, too. WebGL cannot clamp depths of fragments.
  gl_Position.z = max(gl_Position.z, -gl_Position.w);
}`;

const FRAGMENT = `
uniform sampler2D furrowMap;
uniform vec2 furrowCutOff;  // x: opacity, y: the cut-off
varying vec2 vFurrowUv;
void main() {
  #ifdef FURROW_CUT_OUT
  if (furrowCutOff.x * texture2D(furrowMap, vFurrowUv).a < furrowCutOff.y) discard;
  #endif
  gl_FragColor = vec4(gl_FragCoord.z, 0.0, 0.0, 1.0);
}`;

interface Caster {
  mesh: SkinnedMesh;
  material: MeshPhysicalMaterial;
  /** Null: the mesh casts no shadow. */
  shadow: ShaderMaterial | null;
}

export class SkinParts {
  /** Of the facets of all materials. StudioView sets them. */
  readonly uniforms = {
    furrowForward: { value: new Vector3(0, 0, -1) },
    furrowGloss: { value: new Vector3(1, 1, 0) },
    furrowShown: { value: new Vector4(1, 1, 1, 1) },
  } satisfies Record<string, IUniform>;
  /** Of the shadow maps. */
  readonly lights: { u_lights: IUniform; u_light: IUniform<number> } = { u_lights: { value: [] }, u_light: { value: 0 } };
  /** Blending into float targets darkens facets. */
  readonly hasShades: boolean;
  private readonly casters: Caster[] = [];

  constructor(renderer: WebGLRenderer) {
    this.hasShades = renderer.extensions.has('EXT_float_blend');
  }

  add(mesh: SkinnedMesh, material: MeshPhysicalMaterial, kind: Kind): void {
    this.casters.push({ mesh, material, shadow: kind === 'shade' ? null : this.shadowOf(material) });
  }

  private shadowOf(material: MeshPhysicalMaterial): ShaderMaterial {
    const known = this.casters.find((caster) => caster.material === material)?.shadow;
    if (known) return known;
    const isCutOut = material.alphaTest > 0 && material.map !== null;
    return new ShaderMaterial({
      name: `${material.name} in shadow maps`,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: material.side,
      blending: NoBlending,
      defines: isCutOut ? { FURROW_CUT_OUT: '' } : {},
      uniforms: {
        ...this.lights,
        furrowMap: { value: material.map },
        furrowUv: { value: material.map?.matrix ?? new Matrix3() },
        furrowCutOff: { value: [material.opacity, material.alphaTest] },
      },
    });
  }

  /** Calls `draw` while the meshes have the materials of shadow maps. */
  drawShadows(draw: () => void): void {
    const visible = this.casters.map(({ mesh }) => mesh.visible);
    for (const { mesh, shadow } of this.casters) {
      if (shadow) mesh.material = shadow;
      else mesh.visible = false;
    }
    try {
      draw();
    } finally {
      this.casters.forEach(({ mesh, material }, i) => {
        mesh.material = material;
        mesh.visible = visible[i]!;
      });
    }
  }

  dispose(): void {
    for (const { shadow } of this.casters) shadow?.dispose();
  }
}
