// SPDX-License-Identifier: Apache-2.0
// Draws characters as the daemon does, with its lamps and its settings: shading "diffuse" by their own materials, and
// shading "skin" where the GPU can.
import { Color, type PerspectiveCamera, Vector3, type WebGLRenderer, type WebGLRenderTarget } from 'three';
import type { FurrowCharacter } from '../character.js';
import { SkinView } from '../skin/skin_view.js';
import { whyNoSkin } from '../skin/support.js';
import { defaultSettings, type StudioSettings } from '../settings.js';

export interface StudioViewOptions {
  /** False: always draws shading "diffuse" (default: true). */
  skin?: boolean;
}

export class StudioView {
  /** May change between pictures. */
  settings: StudioSettings = defaultSettings();
  private skin: SkinView | null = null;
  private readonly why: string;

  constructor(private readonly renderer: WebGLRenderer, options: StudioViewOptions = {}) {
    this.why = options.skin === false ? 'skin shading is switched off' : whyNoSkin(renderer);
  }

  /** Why these characters cannot be drawn with skin shading; empty: they can. */
  whyNoSkin(characters: readonly FurrowCharacter[]): string {
    return this.why || (characters.find(({ skin }) => skin === null)?.whyNoSkin ?? '');
  }

  /**
   * Draws a picture of the characters, on the background of the settings. The lamps surround `target`, the point that the
   * camera looks at. `output`: default: the canvas. Other objects of a scene are not drawn. Draws shading "diffuse" if
   * there is a reason against skin (whyNoSkin()).
   */
  render(characters: readonly FurrowCharacter[], camera: PerspectiveCamera, target: Vector3, output: WebGLRenderTarget | null = null): void {
    const { settings } = this;
    const wantsSkin = settings.shading === 'skin' || settings.view !== 'final';
    for (const character of characters) character.updateWorldMatrix(true, false);
    if (wantsSkin && this.whyNoSkin(characters) === '') {
      this.skin ??= new SkinView(this.renderer);
      this.skin.render(characters, camera, target, settings, output);
    } else {
      this.renderDiffuse(characters, camera, target, output);
    }
  }

  private renderDiffuse(characters: readonly FurrowCharacter[], camera: PerspectiveCamera, target: Vector3, output: WebGLRenderTarget | null): void {
    const { renderer, settings } = this;
    const former = { autoClear: renderer.autoClear, colour: renderer.getClearColor(new Color()), alpha: renderer.getClearAlpha() };
    renderer.autoClear = false;
    renderer.setRenderTarget(output);
    renderer.setClearColor(new Color().setRGB(...settings.background, 'srgb-linear'), 1);
    renderer.clear();
    for (const character of characters) {
      character.setView('studio');
      character.studio.update(camera, target, settings.lights);
      renderer.render(character, camera);
    }
    renderer.setClearColor(former.colour, former.alpha);
    renderer.autoClear = former.autoClear;
    renderer.setRenderTarget(null);
  }

  /** Frees all memory of the GPU that the view holds. The characters stay. */
  dispose(): void {
    this.skin?.dispose();
    this.skin = null;
  }
}
