// SPDX-License-Identifier: Apache-2.0
// The targets of skin shading for one size of picture, with the formats of render/passes/scene_pass.cpp and its neighbours.
import {
  DepthTexture, FloatType, HalfFloatType, LessEqualCompare, LinearFilter, NearestFilter, NoColorSpace, type PixelFormat, RedFormat,
  RGBAFormat, type TextureDataType, UnsignedByteType, WebGLRenderTarget,
} from 'three';

interface Format {
  format: PixelFormat;
  type: TextureDataType;
}
const RGBA8: Format = { format: RGBAFormat, type: UnsignedByteType };
const R8: Format = { format: RedFormat, type: UnsignedByteType };
const RGBA16F: Format = { format: RGBAFormat, type: HalfFloatType };
const RGBA32F: Format = { format: RGBAFormat, type: FloatType };
const R32F: Format = { format: RedFormat, type: FloatType };


function make(width: number, height: number, formats: readonly Format[], depth: DepthTexture | null, linear = false): WebGLRenderTarget {
  const filter = linear ? LinearFilter : NearestFilter;
  const target = new WebGLRenderTarget(width, height, {
    count: formats.length, depthBuffer: depth !== null, depthTexture: depth, minFilter: filter, magFilter: filter,
    colorSpace: NoColorSpace, generateMipmaps: false,
  });
  target.textures.forEach((texture, i) => Object.assign(texture, formats[i]));
  return target;
}

export class SkinTargets {
  /** Base colour, normal, geometric normal, matter, depth, emission. */
  readonly facets: WebGLRenderTarget;
  /** Irradiance on skin, other radiance, albedo. */
  readonly lit: WebGLRenderTarget;
  readonly across: WebGLRenderTarget;
  readonly scattered: WebGLRenderTarget;
  readonly light: WebGLRenderTarget;
  readonly noisy: WebGLRenderTarget;
  readonly open: WebGLRenderTarget;
  readonly bloom: [WebGLRenderTarget, WebGLRenderTarget];
  readonly picture: WebGLRenderTarget;

  /** `occlusionScale`: scene pixels per occlusion pixel, along each axis. */
  constructor(readonly width: number, readonly height: number, readonly occlusionScale: number) {
    const z = new DepthTexture(width, height, FloatType);
    this.facets = make(width, height, [RGBA8, RGBA16F, RGBA8, RGBA8, R32F, RGBA16F], z);
    this.lit = make(width, height, [RGBA16F, RGBA16F, RGBA8], z);
    this.across = make(width, height, [RGBA32F], z);
    this.scattered = make(width, height, [RGBA32F], z);
    this.light = make(width, height, [RGBA16F], z);
    const [openWidth, openHeight] = [Math.ceil(width / occlusionScale), Math.ceil(height / occlusionScale)];
    this.noisy = make(openWidth, openHeight, [R8], null);
    this.open = make(openWidth, openHeight, [R8], null);
    const small = (): WebGLRenderTarget =>
      make(Math.max(width >> 2, 1), Math.max(height >> 2, 1), [RGBA16F], null, true);
    this.bloom = [small(), small()];
    this.picture = make(width, height, [RGBA8], null, true);
  }

  fits(width: number, height: number, occlusionScale: number): boolean {
    return this.width === width && this.height === height && this.occlusionScale === occlusionScale;
  }

  dispose(): void {
    const { facets, lit, across, scattered, light, noisy, open, bloom, picture } = this;
    for (const target of [facets, lit, across, scattered, light, noisy, open, ...bloom, picture]) target.dispose();
  }
}

/** The lamps' shadow maps side by side: depths as a colour, to read, and as depths, to compare with. */
export function makeShadowTarget(texels: number, lamps: number): WebGLRenderTarget {
  const depths = new DepthTexture(texels * lamps, texels, FloatType);
  depths.compareFunction = LessEqualCompare;
  depths.minFilter = depths.magFilter = LinearFilter;
  return make(texels * lamps, texels, [R32F], depths);
}
