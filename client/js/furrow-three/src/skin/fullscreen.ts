// SPDX-License-Identifier: Apache-2.0
// Passes that cover the picture, drawn by the renderer's fragment shaders.
import {
  AlwaysDepth, BufferGeometry, Camera, CustomBlending, GLSL3, GreaterDepth, Mesh, NoBlending, OneFactor, RawShaderMaterial,
  type WebGLRenderer, type WebGLRenderTarget, ZeroFactor,
} from 'three';
import { type Defines, glslOf, PRECISION } from './glsl.js';

const NAME = 'common/fullscreen.vert.glsl';

export interface FullscreenPass {
  /** Path below shaders/. */
  fragment: string;
  defines?: Defines;
  /** Values by name. The names of one shader are always the same. */
  uniforms: Readonly<Record<string, unknown>>;
  /** Null: the canvas. */
  target: WebGLRenderTarget | null;
  /** Only where the target's depth buffer holds a surface. */
  onSurface?: boolean;
  /** The target keeps its alpha. */
  keepsAlpha?: boolean;
}

export class Fullscreen {
  private readonly materials = new Map<string, RawShaderMaterial>();
  private readonly camera = new Camera();
  private readonly mesh: Mesh;

  constructor(private readonly renderer: WebGLRenderer) {
    const geometry = new BufferGeometry(); // without attributes: the shader makes the triangle
    geometry.setDrawRange(0, 3);
    this.mesh = new Mesh(geometry);
    this.mesh.frustumCulled = false;
  }

  private materialOf({ fragment, defines = {}, uniforms, onSurface = false, keepsAlpha = false }: FullscreenPass): RawShaderMaterial {
    const key = JSON.stringify([fragment, defines, onSurface, keepsAlpha]);
    const known = this.materials.get(key);
    if (known) return known;
    const material = new RawShaderMaterial({
      name: fragment,
      glslVersion: GLSL3,
      vertexShader: PRECISION + glslOf(NAME),
      fragmentShader: PRECISION + glslOf(fragment, defines),
      uniforms: Object.fromEntries(Object.keys(uniforms).map((name) => [name, { value: null }])),
      // The triangle lies at the far plane, so it passes where something is nearer.
      depthTest: onSurface,
      depthFunc: onSurface ? GreaterDepth : AlwaysDepth,
      depthWrite: false,
      blending: keepsAlpha ? CustomBlending : NoBlending,
      blendSrc: OneFactor,
      blendDst: ZeroFactor,
      blendSrcAlpha: ZeroFactor,
      blendDstAlpha: OneFactor,
    });
    this.materials.set(key, material);
    return material;
  }

  draw(pass: FullscreenPass): void {
    const material = this.materialOf(pass);
    for (const [name, value] of Object.entries(pass.uniforms)) material.uniforms[name]!.value = value;
    material.uniformsNeedUpdate = true;
    this.mesh.material = material;
    this.renderer.setRenderTarget(pass.target);
    this.renderer.render(this.mesh, this.camera);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    for (const material of this.materials.values()) material.dispose();
    this.materials.clear();
  }
}
