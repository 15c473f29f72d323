// SPDX-License-Identifier: Apache-2.0
// Normal maps as slopes n.xy / n.z in half floats, with mip levels of the slopes: sums of slopes are exact where heights
// add up, and the base map's pores survive (docs/ALGORITHM.md). Squares of the slopes beside them are for skin.
import {
  GLSL3, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, Mesh, NoBlending, NoColorSpace, OrthographicCamera,
  PlaneGeometry, RepeatWrapping, RGBAFormat, RGFormat, Scene, ShaderMaterial, type Texture, type WebGLRenderer, WebGLRenderTarget,
} from 'three';

const VERTEX = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';

/** kMaxDerivative of render/wrinkles/derivative_map.h. */
const FRAGMENT = `
precision highp float;
uniform highp sampler2D source;
uniform float scale;  // 0: the source holds normals; else the derivative of a full texel
out vec4 slope;       // zw: squares; their mip levels give the variance of the slopes
void main() {
  vec3 texel = texelFetch(source, ivec2(gl_FragCoord.xy), 0).xyz * 2.0 - 1.0;
  vec2 value = scale > 0.0 ? texel.xy * scale : texel.xy / max(texel.z, 1e-3);
  value = clamp(value, vec2(-16.0), vec2(16.0));
  slope = vec4(value, value * value);
}`;

interface Picture {
  width: number;
  height: number;
}

/** Converts pictures on the GPU. Throws an Error if the GPU cannot draw into half floats. */
export class SlopeMaker {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, blending: NoBlending, depthTest: false, depthWrite: false,
    uniforms: { source: { value: null }, scale: { value: 0 } },
  });
  private readonly plane = new PlaneGeometry(2, 2);

  /** `moments`: also store the squares of the slopes. */
  constructor(private readonly renderer: WebGLRenderer, private readonly moments = false) {
    if (!renderer.extensions.has('EXT_color_buffer_float') && !renderer.extensions.has('EXT_color_buffer_half_float')) {
      throw new Error('furrow-three: this GPU cannot draw into half floats (EXT_color_buffer_float)');
    }
    const mesh = new Mesh(this.plane, this.material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  /** `scale`: 0 for a normal map, else that of a derivative map. The caller disposes of the target. */
  make(source: Texture, scale = 0): WebGLRenderTarget {
    const { width, height } = source.image as Picture;
    const target = new WebGLRenderTarget(width, height, {
      format: this.moments ? RGBAFormat : RGFormat, type: HalfFloatType, colorSpace: NoColorSpace, depthBuffer: false, generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter, wrapS: RepeatWrapping, wrapT: RepeatWrapping,
    });
    const { renderer } = this;
    const former = renderer.getRenderTarget();
    source.colorSpace = NoColorSpace;
    this.material.uniforms.source!.value = source;
    this.material.uniforms.scale!.value = scale;
    renderer.setRenderTarget(target);
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(former);
    return target;
  }

  dispose(): void {
    this.material.dispose();
    this.plane.dispose();
  }
}
