// SPDX-License-Identifier: Apache-2.0
// Skin shading as the daemon's renderer draws it with one sample per pixel (render/pipeline.h): shadow maps, facets,
// ambient occlusion, light, separable scattering, bloom, tone map and FXAA, by the renderer's own shaders.
import {
  DataTexture, FloatType, LinearFilter, type PerspectiveCamera, RGBAFormat, type Texture, Vector2, Vector3, Vector4, type WebGLRenderer,
  type WebGLRenderTarget,
} from 'three';
import type { FurrowCharacter } from '../character.js';
import { SKIN_VIEWS, type StudioSettings } from '../settings.js';
import { FrameUniforms, type PictureFrame, pictureFrame } from './frame_uniforms.js';
import { Fullscreen } from './fullscreen.js';
import { KIND_DEFINES, MAX_CURVATURE } from './materials.js';
import { type PixelTaps, pixelKernel } from './pixel_kernel.js';
import { HUMAN_SKIN } from './skin_profile.js';
import { makeShadowTarget, SkinTargets } from './skin_targets.js';
import { ALBEDO_TABLE_SIZE, twoLobeAlbedoTable } from './specular_albedo.js';

const LAMPS = 3;
/** Depth that means "no surface", metres. */
const NO_SURFACE = 1e6;
/** FAR_AWAY of shaders/skin/scatter.glsl. */
const FAR_AWAY = 60000;
/** Smaller widths of scattering have no visible effect. */
const LEAST_WIDTH = 0.01;
/** Surfaces farther apart than this share of the occlusion's radius do not share their openness. */
const OCCLUSION_RANGE = 0.5;
const MAX_TAPS = 21;
const FILTERS = { off: 0, pcf: 1, pcss: 2 } as const;
const VIEW_DEFINES = Object.fromEntries(SKIN_VIEWS.map((view, i) => [`VIEW_${view.toUpperCase()}`, i]));
const SHOWN_AS = { final: 2, specular: 2, translucency: 2, albedo: 1, shadow: 0, material: 0 } as const;

export class SkinView {
  private readonly fullscreen: Fullscreen;
  private readonly frameUniforms = new FrameUniforms();
  private readonly albedoTable: DataTexture;
  private targets: SkinTargets | null = null;
  private shadows: WebGLRenderTarget | null = null;
  private kernel: { key: string; offsets: Float32Array; weights: Float32Array; count: number } | null = null;

  constructor(private readonly renderer: WebGLRenderer) {
    this.fullscreen = new Fullscreen(renderer);
    const size = ALBEDO_TABLE_SIZE;
    this.albedoTable = new DataTexture(twoLobeAlbedoTable(), size, size, RGBAFormat, FloatType);
    // Linear between texels, if the GPU can filter floats.
    if (renderer.extensions.has('OES_texture_float_linear')) this.albedoTable.minFilter = this.albedoTable.magFilter = LinearFilter;
    this.albedoTable.needsUpdate = true;
  }

  /** All characters must have `skin`. `output`: null: the canvas. */
  render(characters: readonly FurrowCharacter[], camera: PerspectiveCamera, target: Vector3, settings: StudioSettings,
    output: WebGLRenderTarget | null): void {
    const { renderer } = this;
    const size = output ? new Vector2(output.width, output.height) : renderer.getDrawingBufferSize(new Vector2());
    camera.updateMatrixWorld();
    const frame = pictureFrame(camera, target, settings, size.x, size.y);
    this.prepareTargets(frame, settings);
    const uniforms = this.frameUniforms.of(frame, camera, settings);
    const { autoClear } = renderer;
    renderer.autoClear = false;
    try {
      this.drawShadows(characters, camera, frame, settings, uniforms);
      this.drawFacets(characters, camera, frame, settings);
      this.finish(frame, settings, uniforms, characters.some(({ emits }) => emits), output);
    } finally {
      renderer.autoClear = autoClear;
      renderer.setRenderTarget(null);
    }
  }

  private prepareTargets({ width, height, shadowTexels }: PictureFrame, settings: StudioSettings): void {
    const scale = settings.occlusion.half_resolution ? 2 : 1;
    if (!this.targets?.fits(width, height, scale)) {
      this.targets?.dispose();
      this.targets = new SkinTargets(width, height, scale);
    }
    if (this.shadows?.height !== shadowTexels) {
      this.shadows?.dispose();
      this.shadows = makeShadowTarget(shadowTexels, LAMPS);
    }
  }

  /** Binds a target and clears its colours, one value each, and its depths. */
  private clear(target: WebGLRenderTarget | null, colours: readonly (readonly number[])[], clearsDepth: boolean): void {
    const { renderer } = this;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    renderer.setRenderTarget(target);
    renderer.state.buffers.color.setMask(true);
    colours.forEach((colour, i) => gl.clearBufferfv(gl.COLOR, i, [...colour]));
    if (!clearsDepth) return;
    renderer.state.buffers.depth.setMask(true);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
  }

  private lampsWithShadows({ shadow }: StudioSettings): number {
    return shadow.filter === 'off' ? 0 : shadow.lamps;
  }

  private drawShadows(characters: readonly FurrowCharacter[], camera: PerspectiveCamera, { shadowTexels }: PictureFrame,
    settings: StudioSettings, uniforms: Record<string, unknown>): void {
    const maps = this.shadows!;
    const lamps = this.lampsWithShadows(settings);
    if (lamps === 0) return;
    maps.viewport.set(0, 0, maps.width, maps.height);
    this.clear(maps, [[1, 0, 0, 1]], true);
    for (let lamp = 0; lamp < lamps; ++lamp) {
      maps.viewport.set(lamp * shadowTexels, 0, shadowTexels, shadowTexels);
      this.renderer.setRenderTarget(maps);
      for (const character of characters) {
        const { skin } = character;
        if (!skin) continue;
        skin.lights.u_lights.value = uniforms.u_lights;
        skin.lights.u_light.value = lamp;
        skin.drawShadows(() => this.renderer.render(character, camera));
      }
    }
  }

  private drawFacets(characters: readonly FurrowCharacter[], camera: PerspectiveCamera, frame: PictureFrame, settings: StudioSettings): void {
    const { facets } = this.targets!;
    const none = [0, 0, 0, 0];
    this.clear(facets, [none, none, none, none, [NO_SURFACE, 0, 0, 0], none], true);
    const { specular, wrinkles, wrinkle_strength: strength, wrinkle_maps: maps } = settings;
    for (const character of characters) {
      const { skin } = character;
      if (!skin) continue;
      skin.uniforms.furrowForward.value.copy(frame.forward);
      skin.uniforms.furrowGloss.value.set(specular.roughness, specular.widen ? 1 : 0, 0);
      skin.uniforms.furrowShown.value.set(wrinkles ? 1 : 0, strength, maps.blood_flow, maps.cavity);
      character.setView('facets');
      this.renderer.render(character, camera);
    }
  }

  private finish(frame: PictureFrame, settings: StudioSettings, uniforms: Record<string, unknown>, emits: boolean,
    output: WebGLRenderTarget | null): void {
    const { lit } = this.targets!;
    const isWhole = settings.view === 'final';
    const open = isWhole ? this.occlude(frame, settings) : null;
    this.light(frame, settings, uniforms, emits, open);
    if (!isWhole) return this.present(settings, lit.textures[1]!, null, output);
    const light = this.combine(settings, this.scatter(frame, settings));
    this.present(settings, light, this.bloom(settings, light), output);
  }

  private lens({ width, height, pixelsPerSlope, viewRotation }: PictureFrame): Record<string, unknown> {
    return { u_view_rotation: viewRotation, u_lens: new Vector4(pixelsPerSlope, 0.5 * width, 0.5 * height, 0) };
  }

  /** The visible share of the sky; null: all of it. */
  private occlude(frame: PictureFrame, { occlusion }: StudioSettings): Texture | null {
    const { facets, noisy, open, occlusionScale } = this.targets!;
    if (occlusion.method === 'off' || occlusion.strength <= 0) return null;
    const [depth, normal] = [facets.textures[4], facets.textures[1]];
    this.fullscreen.draw({
      fragment: `occlusion/${occlusion.method}.frag.glsl`,
      defines: { SCALE: occlusionScale, SAMPLES: occlusion.samples },
      uniforms: { u_depth: depth, u_normal: normal, u_reach: new Vector2(0.001 * occlusion.radius_mm, occlusion.strength), ...this.lens(frame) },
      target: noisy,
    });
    this.fullscreen.draw({
      fragment: 'occlusion/occlusion_blur.frag.glsl',
      defines: { SCALE: occlusionScale },
      uniforms: { u_open: noisy.texture, u_depth: depth, u_range: this.occlusionRange(occlusion.radius_mm) },
      target: open,
    });
    return open.texture;
  }

  private occlusionRange(radiusMm: number): number {
    return 0.001 * radiusMm * OCCLUSION_RANGE;
  }

  private light(frame: PictureFrame, settings: StudioSettings, uniforms: Record<string, unknown>, emits: boolean, open: Texture | null): void {
    const { facets, lit, occlusionScale } = this.targets!;
    const lamps = this.lampsWithShadows(settings);
    const isWhole = settings.view === 'final';
    const background = isWhole ? settings.background : [0, 0, 0];
    this.clear(lit, [[0, 0, 0, FAR_AWAY], [...background, 0], [0, 0, 0, 0]], false);
    this.fullscreen.draw({
      fragment: 'skin/light.frag.glsl',
      defines: {
        ...KIND_DEFINES, ...VIEW_DEFINES, VIEW: VIEW_DEFINES[`VIEW_${settings.view.toUpperCase()}`]!,
        MATERIAL: 0, MATERIALS: 1, MAX_CURVATURE, RING_SIZE: '48.0', BECKMANN_SIZE: '512.0', ALBEDO_SIZE: `float(${ALBEDO_TABLE_SIZE})`,
        SHADOW_FILTER: FILTERS[settings.shadow.filter], SHADOW_TAPS: settings.shadow.taps, SHADOW_LAMPS: lamps,
        TRANSLUCENCY: settings.translucency.enabled && lamps > 0, PREINTEGRATED: 0, BECKMANN_TABLE: 0,
        SPECULAR_GEMS: settings.specular.mode === 'gems', CONSERVE: settings.specular.conserve_energy,
        OCCLUSION: open !== null, SCALE: occlusionScale, EMISSION: emits, SHADOWS_BEFORE: false,
      },
      uniforms: {
        ...uniforms, ...this.lens(frame),
        u_colour: facets.textures[0], u_normal: facets.textures[1], u_geometric: facets.textures[2], u_matter: facets.textures[3],
        u_depth: facets.textures[4], u_emission: facets.textures[5], u_open: open,
        u_shadow_compare: this.shadows!.depthTexture, u_shadow_depth: this.shadows!.texture, u_albedo_table: this.albedoTable,
        u_range: this.occlusionRange(settings.occlusion.radius_mm),
      },
      target: lit,
      onSurface: true,
    });
  }

  private kernelOf(settings: StudioSettings, pixelsPerMm: number): NonNullable<SkinView['kernel']> {
    const key = `${settings.subsurface.taps} ${pixelsPerMm}`;
    if (this.kernel?.key === key) return this.kernel;
    const { offsets, weights }: PixelTaps = pixelKernel(HUMAN_SKIN, settings.subsurface.taps, pixelsPerMm);
    const padded = (values: readonly (readonly number[])[], per: number): Float32Array => {
      const array = new Float32Array(per * MAX_TAPS);
      array.set(values.flat());
      return array;
    };
    return this.kernel = { key, offsets: padded(offsets, 2), weights: padded(weights, 3), count: offsets.length };
  }

  /** Scatters the light on skin along x and then along y. */
  private scatter(frame: PictureFrame, settings: StudioSettings): Texture {
    const { lit, across, scattered } = this.targets!;
    const { subsurface } = settings;
    const irradiance = lit.textures[0]!;
    if (subsurface.method === 'off' || subsurface.strength <= 0 || subsurface.width < LEAST_WIDTH) return irradiance;
    const kernel = this.kernelOf(settings, (subsurface.width * 0.001 * frame.pixelsPerSlope) / frame.focusDistance);
    const turned = kernel.offsets.map((_, i) => (i % 2 === 0 ? -kernel.offsets[i + 1]! : kernel.offsets[i - 1]!));
    const draw = (axis: 0 | 1, from: Texture, target: WebGLRenderTarget): void => {
      this.clear(target, [[0, 0, 0, FAR_AWAY]], false);
      this.fullscreen.draw({
        fragment: 'skin/separable.frag.glsl',
        uniforms: {
          u_irradiance: from, u_unscattered: irradiance,
          u_axis: new Vector2(1 - axis, axis), u_num_taps: kernel.count - 1,
          u_geometry: new Vector3(frame.focusDistance, 1000 / subsurface.depth_range_mm, subsurface.gradient),
          u_strength: axis === 0 ? 1 : subsurface.strength,
          u_offset: axis === 0 ? kernel.offsets : turned, u_weight: kernel.weights,
        },
        target,
        onSurface: true,
      });
    };
    draw(0, irradiance, across);
    draw(1, across.texture, scattered);
    return scattered.texture;
  }

  private combine({ background }: StudioSettings, scattered: Texture): Texture {
    const { lit, light } = this.targets!;
    this.clear(light, [[...background, 1]], false);
    this.fullscreen.draw({
      fragment: 'skin/combine.frag.glsl',
      uniforms: { u_scattered: scattered, u_radiance: lit.textures[1], u_albedo: lit.textures[2] },
      target: light,
      onSurface: true,
    });
    return light.texture;
  }

  private bloom({ bloom, exposure }: StudioSettings, light: Texture): Texture | null {
    if (bloom.strength <= 0) return null;
    const [first, second] = this.targets!.bloom;
    const draw = (bright: boolean, from: Texture, look: Vector4, target: WebGLRenderTarget): void =>
      this.fullscreen.draw({ fragment: 'post/bloom.frag.glsl', defines: { BRIGHT: bright }, uniforms: { u_light: from, u_look: look }, target });
    const sigma = Math.max(bloom.radius * first.height, 0.3);
    draw(true, light, new Vector4(bloom.threshold, exposure, 0, 0), first);
    draw(false, first.texture, new Vector4(1, 0, sigma, 0), second);
    draw(false, second.texture, new Vector4(0, 1, sigma, 0), first);
    return first.texture;
  }

  /** The picture, smoothed by FXAA if it shows light. */
  private present(settings: StudioSettings, shown: Texture, bloom: Texture | null, output: WebGLRenderTarget | null): void {
    const { picture } = this.targets!;
    const isWhole = settings.view === 'final';
    this.clear(output, [], false);
    this.clearOutput();
    this.fullscreen.draw({
      fragment: 'post/composite.frag.glsl',
      defines: { SAMPLES: 1, SHOW: SHOWN_AS[settings.view], BLOOM: bloom !== null, TONE_MAP: settings.tone_map === 'neutral' ? 0 : 1, BOTTOM_UP: 1 },
      uniforms: { u_shown: shown, u_exposure: settings.exposure, u_bloom: bloom, u_bloom_strength: settings.bloom.strength },
      target: isWhole ? picture : output,
      keepsAlpha: !isWhole,
    });
    if (isWhole) this.fullscreen.draw({ fragment: 'post/fxaa.frag.glsl', uniforms: { u_picture: picture.texture }, target: output, keepsAlpha: true });
  }

  /** Opaque: the alpha of the last pass is luma. */
  private clearOutput(): void {
    const gl = this.renderer.getContext();
    this.renderer.state.buffers.color.setMask(true);
    this.renderer.state.buffers.color.setClear(0, 0, 0, 1, false);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  dispose(): void {
    this.fullscreen.dispose();
    this.albedoTable.dispose();
    this.targets?.dispose();
    this.shadows?.dispose();
    this.targets = this.shadows = null;
  }
}
