// SPDX-License-Identifier: Apache-2.0
// One setting as a row of the menu: chooses its control and converts between the setting's text and
// the control's value. Uses only the daemon's description of the setting, never its name.
import type { BindingApi, BindingParams, FolderApi } from '@tweakpane/core';
import type { SettingInfo } from '../api';
import { toLinear, toSrgb } from '../light/srgb';
import { isOn } from '../state/settings';
import { text as words } from '../text';
import { button, readable } from '../ui/dom';

const hexByte = (x: number): string => Math.round(255 * Math.min(1, Math.max(0, x))).toString(16).padStart(2, '0');

/** Converts a setting's text to the control's value. Colours are linear on the wire, sRGB in the picker. */
export function toControl(info: SettingInfo, text: string): string | number | boolean {
  switch (info.kind) {
    case 'bool':
      return isOn(text);
    case 'int':
    case 'number':
      return Number(text);
    case 'colour':
      return `#${text.split(',').map((part) => hexByte(toSrgb(Number(part)))).join('')}`;
    default:
      return text;
  }
}

export function fromControl(info: SettingInfo, value: unknown): string {
  switch (info.kind) {
    case 'bool':
      return value === true ? 'on' : 'off';
    case 'number':
      return String(Number((value as number).toPrecision(6)));
    case 'colour': {
      const bytes = /^#(..)(..)(..)/.exec(value as string)!.slice(1).map((hex) => parseInt(hex, 16));
      return bytes.map((byte) => String(Number(toLinear(byte / 255).toFixed(5)))).join(',');
    }
    default:
      return String(value);
  }
}

/** Returns "softness (mm)" for "shadow.softness_mm". */
export function labelOf(info: SettingInfo): string {
  let name = info.name.slice(info.name.indexOf('.') + 1);
  if (info.unit !== '' && name.endsWith(`_${info.unit}`)) name = name.slice(0, -info.unit.length - 1);
  return info.unit === '' ? readable(name) : `${readable(name)} (${info.unit})`;
}

function bindingParams(info: SettingInfo): BindingParams {
  const params: Record<string, unknown> = { label: labelOf(info) };
  if (info.kind === 'choice') {
    params.options = Object.fromEntries((info.choices ?? []).map((word) => [readable(word), word]));
  } else if (info.kind === 'int' || info.kind === 'number') {
    const { min, max } = info;
    if (min !== null) params.min = min;
    if (max !== null) params.max = max;
    if (info.choices !== undefined && info.choices.length > 0) {
      params.options = Object.fromEntries(info.choices.map((word) => [word, Number(word)]));
    } else if (info.kind === 'int') {
      params.step = 1;
    } else if (min !== null && max !== null) {
      params.step = 10 ** Math.floor(Math.log10((max - min) / 100));
    }
  }
  return params as BindingParams;
}

export interface RowEvents {
  onChange(text: string): void;
  onReset(): void;
  /** The pointer or the focus is on the row. */
  onPointed(): void;
}

export class SettingRow {
  private readonly holder: { value: ReturnType<typeof toControl> };
  private readonly binding: BindingApi;
  private readonly resetButton: HTMLButtonElement;
  private refreshing = false;

  constructor(folder: FolderApi, readonly info: SettingInfo, text: string, events: RowEvents) {
    this.holder = { value: toControl(info, text) };
    this.binding = folder.addBinding(this.holder, 'value', bindingParams(info));
    this.binding.on('change', (event: { value: unknown }) => {
      if (!this.refreshing) events.onChange(fromControl(info, event.value));
    });
    const label = labelOf(info);
    const element = this.element;
    element.dataset.setting = info.name;
    element.title = info.help;
    for (const input of element.querySelectorAll('input, select')) {
      input.setAttribute('aria-label', `${readable(info.group)}: ${label}`);
      input.setAttribute('aria-description', info.help);
    }
    // Tweakpane's colour swatch is a button without a name.
    for (const swatch of element.querySelectorAll('button')) swatch.setAttribute('aria-label', words.menu.picker(label));
    this.resetButton = button('↺', events.onReset, {
      class: 'reset', title: words.menu.resetOne, 'aria-label': words.menu.resetNamed(label), hidden: true,
    });
    element.append(this.resetButton);
    for (const type of ['pointerenter', 'pointerdown', 'focusin'] as const) element.addEventListener(type, events.onPointed);
  }

  get element(): HTMLElement {
    return this.binding.element;
  }

  refresh(text: string, changed: boolean): void {
    this.refreshing = true;
    this.holder.value = toControl(this.info, text);
    this.binding.refresh();
    this.refreshing = false;
    this.resetButton.hidden = !changed;
    this.element.classList.toggle('changed', changed);
  }

  /** Shows or hides the row. Returns true if the row matches. */
  filter(query: string): boolean {
    const { name, group, help, unit, choices } = this.info;
    const haystack = [name, readable(group), help, unit, labelOf(this.info), ...(choices ?? [])].join(' ').toLowerCase();
    const matches = query.toLowerCase().split(/\s+/).every((word) => haystack.includes(word));
    this.binding.hidden = !matches;
    return matches;
  }
}
