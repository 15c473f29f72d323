// SPDX-License-Identifier: Apache-2.0
// A copy of a part of the page for an image, in which no script runs: what scripts have set or drawn becomes part of the
// markup.
import { h, pngOf } from '../ui/dom';

/** Values that the user has entered are properties, which markup does not have. */
function keepValue(original: Element, copy: Element): void {
  if (original instanceof HTMLInputElement) {
    if (original.type === 'password') return; // a secret
    copy.setAttribute('value', original.value);
    copy.toggleAttribute('checked', original.checked);
  } else if (original instanceof HTMLTextAreaElement) {
    copy.textContent = original.value;
  } else if (original instanceof HTMLOptionElement) {
    copy.toggleAttribute('selected', original.selected);
  }
}

/** An image is never scrolled, so its content is moved instead. Scroll bars would say otherwise, so only their room remains. */
function keepScroll(original: HTMLElement, copy: HTMLElement): void {
  const style = getComputedStyle(original);
  if (![style.overflowX, style.overflowY].some((overflow) => overflow === 'auto' || overflow === 'scroll')) return;
  const { scrollLeft, scrollTop } = original;
  const bar = original.offsetWidth - original.clientWidth - parseFloat(style.borderLeftWidth) - parseFloat(style.borderRightWidth);
  copy.style.scrollbarWidth = 'none';
  copy.style.paddingRight = `${parseFloat(style.paddingRight) + Math.max(0, bar)}px`;
  if (scrollLeft === 0 && scrollTop === 0) return;
  const [first] = copy.children;
  // In the flow where that is possible, because what sticks to an edge then stays there.
  if (scrollLeft === 0 && style.display === 'block' && first instanceof HTMLElement) {
    first.style.marginTop = `${-scrollTop}px`;
    return;
  }
  for (const child of copy.children) (child as HTMLElement).style.translate = `${-scrollLeft}px ${-scrollTop}px`;
}

function dataUrl(blob: Blob): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result as string);
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });
}

/** Without scripts, browsers treat a canvas as text. It keeps its place and gets its picture as background. */
async function keepDrawing(original: HTMLCanvasElement, copy: HTMLElement): Promise<void> {
  const { width, height } = original;
  if (original.getClientRects().length === 0 || width === 0 || height === 0) return;
  const still = h('canvas', { width, height });
  still.getContext('2d')!.drawImage(original, 0, 0); // at once: WebGL drops its picture after the task that drew it
  const style = getComputedStyle(original);
  const size = style.objectFit === 'cover' ? 'cover' : '100% 100%';
  Object.assign(copy.style, {
    display: style.display === 'inline' ? 'inline-block' : style.display, width: style.width, height: style.height,
  });
  copy.style.background = `url("${await dataUrl(await pngOf(still))}") center / ${size} no-repeat`;
}

export async function copyOf(root: HTMLElement): Promise<HTMLElement> {
  const copy = root.cloneNode(true) as HTMLElement;
  const copies = [copy, ...copy.querySelectorAll<HTMLElement>('*')];
  const drawings: Promise<void>[] = [];
  [root, ...root.querySelectorAll('*')].forEach((original, i) => {
    keepValue(original, copies[i]!);
    if (original instanceof HTMLElement) keepScroll(original, copies[i]!);
    if (original instanceof HTMLCanvasElement) drawings.push(keepDrawing(original, copies[i]!));
  });
  await Promise.all(drawings);
  for (const closed of copy.querySelectorAll('dialog:not([open])')) closed.remove();
  return copy;
}
