// SPDX-License-Identifier: Apache-2.0
// Creates elements in one expression. Text is always set as text, never parsed as HTML.

type Attributes = Record<string, string | number | boolean | EventListener | undefined>;
type Child = Node | string | null;

function fill(element: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child) => child !== null));
}

/** `onclick` and similar take a listener. An attribute with the value false or undefined is left out. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]): SVGElementTagNameMap[K] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  fill(element, attributes, children);
  return element;
}

export function button(label: string, onClick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick: onClick, ...attributes }, label);
}

/** A command that breaks between its words only, and not at their hyphens. */
export function command(words: string): HTMLElement {
  return h('code', {}, ...words.split(' ').flatMap((word, i) => [i === 0 ? null : ' ', h('span', {}, word)]));
}

/** Makes a select with a label for screen readers. */
export function select(label: string, options: readonly (readonly [string, string])[],
                       onChange: (value: string) => void): HTMLSelectElement {
  const element = h('select', { 'aria-label': label });
  setOptions(element, options);
  element.addEventListener('change', () => onChange(element.value));
  return element;
}

/** Does nothing if the options are unchanged, so that an open list stays open. */
export function setOptions(element: HTMLSelectElement, options: readonly (readonly [string, string])[]): void {
  const now = Array.from(element.options, (option) => [option.value, option.text]);
  if (JSON.stringify(now) === JSON.stringify(options)) return;
  const chosen = element.value;
  element.replaceChildren(...options.map(([value, text]) => h('option', { value }, text)));
  if (options.some(([value]) => value === chosen)) element.value = chosen;
}

/** True if the element handles keys itself, as text or as a control, so that they are not page commands. */
export function takesKeys(target: EventTarget | null): boolean {
  return target instanceof Element &&
    target.closest('input, select, textarea, button, [role=tab], [role=slider], dialog, a') !== null;
}

export function download(name: string, type: string, text: string): void {
  saveBlob(name, new Blob([text], { type }));
}

export function saveBlob(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** False: the browser forbids it, as browsers do except on https and localhost. */
export async function copyText(words: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(words);
    return true;
  } catch {
    return false;
  }
}

/** What the canvas shows now, as PNG. Fails if the browser cannot encode it. */
export function pngOf(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob === null ? reject(new Error('the browser cannot encode the picture')) : resolve(blob)), 'image/png'));
}

/** Like copyText(), for a picture that may still be in the making. */
export async function copyPng(picture: Promise<Blob>): Promise<boolean> {
  try {
    await navigator.clipboard.write([new ClipboardItem({ 'image/png': picture })]);
    return true;
  } catch {
    return false;
  }
}

/** A readable region name: "Knee left inner" for "knee_l_inner". Left is the subject's left. */
export function regionWords(name: string): string {
  return readable(name.replace(/_l(?=_|$)/, '_left').replace(/_r(?=_|$)/, '_right'));
}

/** A readable name: "Mask dynamic" for "mask_dynamic". */
export function readable(name: string): string {
  const spaced = name.replaceAll('_', ' ');
  return spaced.charAt(0).toUpperCase() + spaced.slice(1);
}
