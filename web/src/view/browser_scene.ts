// SPDX-License-Identifier: Apache-2.0
// The character as this browser draws it. Loaded only when it is needed, because three.js is larger than the page.
import { PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { Follower, type FurrowCharacter, loadCharacter, type Pose, STUDIO_BACKGROUND, type Weights } from 'furrow-three';
import type { PoseFrame, WeightFrame } from 'furrow/protocol';
import type { Camera } from './camera';

/** Also gives the context back, of which browsers allow few. */
function release(renderer: WebGLRenderer): void {
  renderer.dispose();
  if (!renderer.getContext().isContextLost()) renderer.forceContextLoss();
}

export class BrowserScene {
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera();
  private readonly follower: Follower;
  private readonly weightNames: ReadonlySet<string>;
  private hasShaders = true;
  private judged: { skeleton: bigint; layout: bigint; fits: boolean } | null = null;

  private constructor(private readonly renderer: WebGLRenderer, private readonly character: FurrowCharacter) {
    // three.js would only report it, and draw nothing.
    renderer.debug.onShaderError = () => (this.hasShaders = false);
    character.setView('studio');
    this.scene.background = STUDIO_BACKGROUND;
    this.scene.add(character);
    this.follower = new Follower(character);
    this.weightNames = new Set(character.weightNames);
  }

  /** `url`: of the daemon's character for browsers. Throws an Error if the browser or the file cannot do it. */
  static async create(canvas: HTMLCanvasElement, url: string): Promise<BrowserScene> {
    const renderer = new WebGLRenderer({ canvas, antialias: true });
    try {
      return new BrowserScene(renderer, await loadCharacter(url, renderer));
    } catch (error) {
      release(renderer);
      throw error;
    }
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
  draw(pose: Pose, weights: Weights, camera: Camera, width: number, height: number, wait: boolean): void {
    const { renderer, character } = this;
    const { canvas } = renderer.getContext();
    if (canvas.width !== width || canvas.height !== height) renderer.setSize(width, height, false);
    character.setPose(pose);
    character.setWeights(weights);
    character.studio.update(this.camera, this.follower.place(this.camera, camera, width / height));
    renderer.render(this.scene, this.camera);
    if (!this.hasShaders) throw new Error("the GPU's driver rejects the shaders");
    if (!wait) return;
    const gl = renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  dispose(): void {
    this.character.dispose();
    release(this.renderer);
  }
}
