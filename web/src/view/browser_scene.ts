// SPDX-License-Identifier: Apache-2.0
// The character as this browser draws it. Loaded only when it is needed, because three.js is larger than the page.
import { PerspectiveCamera, WebGLRenderer } from 'three';
import { Follower, type FurrowCharacter, loadCharacter, type Pose, StudioView, type Weights } from 'furrow-three';
import type { StudioSettings } from 'furrow-three/settings';
import type { PoseFrame, WeightFrame } from 'furrow/protocol';
import type { Camera } from './camera';

/** Also gives the context back, of which browsers allow few. */
function release(renderer: WebGLRenderer): void {
  renderer.dispose();
  if (!renderer.getContext().isContextLost()) renderer.forceContextLoss();
}

export class BrowserScene {
  private readonly view: StudioView;
  private readonly camera = new PerspectiveCamera();
  private readonly follower: Follower;
  private readonly weightNames: ReadonlySet<string>;
  private hasShaders = true;
  private judged: { skeleton: bigint; layout: bigint; fits: boolean } | null = null;

  private constructor(private readonly renderer: WebGLRenderer, private readonly character: FurrowCharacter) {
    // three.js would only report it, and draw nothing.
    renderer.debug.onShaderError = () => (this.hasShaders = false);
    this.view = new StudioView(renderer);
    this.follower = new Follower(character);
    this.weightNames = new Set(character.weightNames);
  }

  /** `url`: of the daemon's character for browsers. Throws an Error if the browser or the file cannot do it. */
  static async create(canvas: HTMLCanvasElement, url: string, headers: Record<string, string>): Promise<BrowserScene> {
    const renderer = new WebGLRenderer({ canvas, antialias: true });
    try {
      return new BrowserScene(renderer, await loadCharacter(url, renderer, { headers }));
    } catch (error) {
      release(renderer);
      throw error;
    }
  }

  /** Why this browser cannot draw skin shading; empty: it can. */
  get whyNoSkin(): string {
    return this.view.whyNoSkin([this.character]);
  }

  /** True if the pose needs no retargeting, and every weight can be drawn: this picture will be the daemon's. */
  fits(pose: PoseFrame, weights: WeightFrame): boolean {
    const { skeleton } = pose;
    if (this.judged?.skeleton !== skeleton.hash || this.judged.layout !== weights.layout) {
      const fits = skeleton.blendShapeNames.length === 0 && this.character.fits(skeleton) &&
        weights.names.every((name) => this.weightNames.has(name));
      this.judged = { skeleton: skeleton.hash, layout: weights.layout, fits };
    }
    return this.judged.fits;
  }

  /**
   * `wait`: returns when the GPU has drawn the picture, so that its time can be measured. Throws an Error if the GPU's
   * driver rejects the shaders.
   */
  draw(pose: Pose, weights: Weights, settings: StudioSettings, camera: Camera, width: number, height: number, wait: boolean): void {
    const { renderer, character, view } = this;
    const { canvas } = renderer.getContext();
    if (canvas.width !== width || canvas.height !== height) renderer.setSize(width, height, false);
    character.setPose(pose);
    character.setWeights(weights);
    view.settings = settings;
    view.render([character], this.camera, this.follower.place(this.camera, camera, width / height));
    if (!this.hasShaders) throw new Error("the GPU's driver rejects the shaders");
    if (!wait) return;
    const gl = renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  dispose(): void {
    this.view.dispose();
    this.character.dispose();
    release(this.renderer);
  }
}
