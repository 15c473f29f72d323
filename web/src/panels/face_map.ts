// SPDX-License-Identifier: Apache-2.0
// Shows the facial regions as a map, coloured by weight, and all regions of the rig as a list with
// bars. A click on either opens the explanation.
import type { RigInfo } from '../api';
import type { WeightHistory } from '../state/weight_history';
import { text } from '../text';
import { h, regionWords, svg } from '../ui/dom';

const SVG_VIEW = '0 0 200 236';
/**
 * Outlines of the regions that every face rig has. The map faces the viewer, so the subject's left is on the right.
 * The other half is mirrored.
 */
const HALF: Record<string, string> = {
  brow_l: 'M111 78 C122 66 146 62 166 78 C172 62 168 42 156 30 C142 20 124 17 111 17 Z',
  eye_l: 'M114 92 C124 82 150 80 172 88 C176 100 172 116 160 121 C144 126 122 122 114 110 Z',
  mouth_l: 'M102 150 C112 140 122 128 136 128 C150 134 156 150 150 172 C142 196 124 214 102 217 L102 186 C114 186 124 182 130 176 C122 168 112 165 102 166 Z',
};
const MIDDLE: Record<string, string> = {
  glabella: 'M92 84 C90 70 90 58 93 44 L107 44 C110 58 110 70 108 84 Z',
  nose: 'M93 90 L107 90 C108 108 116 124 118 134 C112 146 88 146 82 134 C84 124 92 108 93 90 Z',
};
const OUTLINE = 'M100 6 C146 6 178 40 178 96 C178 156 146 228 100 228 C54 228 22 156 22 96 C22 40 54 6 100 6 Z';

interface RegionView {
  name: string;
  weights: { name: string; map: string }[];
  bars: Map<string, HTMLElement>;
  shape: SVGPathElement | null;
  button: HTMLButtonElement;
}

/** Warm for compressed skin, cool for stretched skin. The larger of the two decides. */
export function colourOf(pressed: number, drawn: number): string {
  const strength = Math.max(pressed, drawn);
  const hue = pressed >= drawn ? 28 : 205;
  return `hsl(${hue} ${Math.round(85 * strength)}% ${Math.round(22 + 38 * strength)}%)`;
}

export class FaceMap {
  readonly map: HTMLElement;
  private readonly picture = svg('svg', { viewBox: SVG_VIEW, class: 'face-map', 'aria-hidden': 'true' });
  readonly list = h('ul', { class: 'regions', 'aria-label': text.faceMap.regions });
  private regions: RegionView[] = [];
  private drawnMs = 0;
  private rigOf = '';

  constructor(private readonly history: WeightHistory, private readonly onChoose: (region: string, weights: string[]) => void) {
    this.map = h('figure', { class: 'map' }, this.picture,
      h('figcaption', {}, h('p', {}, text.faceMap.hint), h('span', { class: 'key pressed' }, text.faceMap.compressed), h('span', { class: 'key drawn' }, text.faceMap.stretched)));
  }

  /** Rebuilds the map only if the regions differ. */
  showRig(rig: RigInfo): void {
    const shape = JSON.stringify(rig.regions);
    if (shape === this.rigOf) return;
    this.rigOf = shape;
    this.build(rig);
  }

  private build(rig: RigInfo): void {
    this.picture.replaceChildren(svg('path', { d: OUTLINE, class: 'outline' }));
    this.regions = rig.regions.map((region) => {
      const choose = (): void => this.onChoose(region.name, region.weights.map(({ name }) => name));
      const bars = new Map(region.weights.map(({ name, map }) => [name, h('span', { class: `bar ${map}` })]));
      const button = h('button', { type: 'button', class: 'region', 'data-region': region.name, onclick: choose },
        h('span', { class: 'name' }, regionWords(region.name)),
        ...region.weights.map(({ name, map }) =>
          h('span', { class: 'weight' }, h('span', { class: 'map-name' }, map), h('span', { class: 'track' }, bars.get(name)!))));
      return { name: region.name, weights: region.weights, bars, shape: this.addShape(region.name, choose), button };
    });
    this.list.replaceChildren(...this.regions.map(({ button }) => h('li', {}, button)));
  }

  private addShape(name: string, choose: () => void): SVGPathElement | null {
    const mirrored = name.replace(/_r$/, '_l');
    const d = MIDDLE[name] ?? HALF[name] ?? HALF[mirrored];
    if (d === undefined) return null;
    const transform = name.endsWith('_r') ? 'translate(200 0) scale(-1 1)' : undefined;
    const shape = svg('path', { d, transform, class: 'region-shape', 'data-region': name, onclick: choose },
      svg('title', {}, regionWords(name)));
    this.picture.append(shape);
    return shape;
  }

  onFrame(): void {
    const nowMs = performance.now();
    if (nowMs - this.drawnMs < 50 || this.map.closest('[hidden]') !== null) return;
    this.drawnMs = nowMs;
    for (const { weights, bars, shape } of this.regions) {
      let pressed = 0;
      let drawn = 0;
      for (const { name, map } of weights) {
        const value = this.history.value(name);
        bars.get(name)!.style.setProperty('--value', value.toFixed(3));
        if (map === 'stretch') drawn = Math.max(drawn, value);
        else pressed = Math.max(pressed, value);
      }
      if (shape !== null) shape.style.fill = colourOf(pressed, drawn);
    }
  }

  setChosen(region: string): void {
    for (const { name, button, shape } of this.regions) {
      button.setAttribute('aria-pressed', String(name === region));
      shape?.classList.toggle('chosen', name === region);
    }
  }
}
