// SPDX-License-Identifier: Apache-2.0
// Normal maps as slopes n.xy / n.z in half floats, with mip levels of the slopes: sums of slopes are exact where heights
// add up, and the base map's pores survive (docs/ALGORITHM.md). Squares of the slopes beside them are for skin.
import {
  GLSL3, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, Mesh, NoBlending, NoColorSpace, OrthographicCamera,
  PlaneGeometry, RepeatWrapping, RGBAFormat, RGFormat, Scene, ShaderMaterial, type Texture, WebGLArrayRenderTarget, type WebGLRenderer,
  type RenderTargetOptions, Vector2, WebGLRenderTarget,
} from 'three';

const VERTEX = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';

/** kMaxDerivative of render/wrinkles/derivative_map.h. */
const FRAGMENT = `
precision highp float;
uniform highp sampler2D source;
uniform vec2 size;    // of the target, texels
uniform float scale;  // 0: the source holds normals; else the derivative of a full texel
out vec4 slope;       // zw: squares; their mip levels give the variance of the slopes
void main() {
  vec3 texel = textureLod(source, gl_FragCoord.xy / size, 0.0).xyz * 2.0 - 1.0;
  vec2 value = scale > 0.0 ? texel.xy * scale : texel.xy / max(texel.z, 1e-3);
  value = clamp(value, vec2(-16.0), vec2(16.0));
  slope = vec4(value, value * value);
}`;

interface Picture {
  width: number;
  height: number;
}

export interface Relief {
  picture: Texture;
  /** 0: a normal map; else the scale of a derivative map. */
  scale: number;
}

/** Converts pictures on the GPU. Throws an Error if the GPU cannot draw into half floats. */
export class SlopeMaker {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, blending: NoBlending, depthTest: false, depthWrite: false,
    uniforms: { source: { value: null }, size: { value: new Vector2() }, scale: { value: 0 } },
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

  /** The caller disposes of the target. */
  make(relief: Relief): WebGLRenderTarget {
    const { width, height } = relief.picture.image as Picture;
    const target = new WebGLRenderTarget(width, height, this.options());
    this.draw(relief, target, 0);
    return target;
  }

  /**
   * The slopes of several pictures as the layers of one texture, because a GPU has few texture units. All layers are as
   * large as the largest picture. The caller disposes of the target.
   */
  makeLayers(reliefs: Relief[]): WebGLArrayRenderTarget {
    const pictures = reliefs.map(({ picture }) => picture.image as Picture);
    const target = new WebGLArrayRenderTarget(
      Math.max(...pictures.map(({ width }) => width)), Math.max(...pictures.map(({ height }) => height)), reliefs.length, this.options());
    reliefs.forEach((relief, layer) => this.draw(relief, target, layer));
    return target;
  }

  private options(): RenderTargetOptions {
    return {
      format: this.moments ? RGBAFormat : RGFormat, type: HalfFloatType, colorSpace: NoColorSpace, depthBuffer: false, generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter, wrapS: RepeatWrapping, wrapT: RepeatWrapping,
    };
  }

  private draw({ picture, scale }: Relief, target: WebGLRenderTarget, layer: number): void {
    const { renderer } = this;
    const former = renderer.getRenderTarget();
    const { source, size, scale: scaled } = this.material.uniforms;
    // A copy, because the picture itself may be in use as a colour.
    const texture = picture.clone();
    texture.colorSpace = NoColorSpace;
    texture.needsUpdate = true;
    source!.value = texture;
    size!.value.set(target.width, target.height);
    scaled!.value = scale;
    renderer.setRenderTarget(target, layer);
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(former);
    texture.dispose();
  }

  dispose(): void {
    this.material.dispose();
    this.plane.dispose();
  }
}
