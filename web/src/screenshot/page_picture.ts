// SPDX-License-Identifier: Apache-2.0
// The page as a PNG. A page may not photograph itself without asking, and what the user then chooses may be another window.
// So a copy of the page is drawn as an SVG image instead, with a caption below it.
import { h, pngOf, svg } from '../ui/dom';
import { copyOf } from './page_copy';
import { styleText } from './style_text';

const FONT_PX = 12;
const LINE_PX = 17;
const MARGIN_PX = 10;
const FONT = `${FONT_PX}px ui-monospace, "DejaVu Sans Mono", monospace`;
const INSETS = ['--safe-top', '--safe-right', '--safe-bottom', '--safe-left'];
/** Characters that XML does not have, even escaped. */
const NOT_XML = /[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g;

/** A data URL: Chromium lets no script read what was drawn from a blob with HTML in it. */
async function imageOf(copy: HTMLElement, width: number, height: number): Promise<HTMLImageElement> {
  const body = h('body', {}, h('style', {}, styleText(document.styleSheets)), copy);
  const drawing = svg('svg', { width, height }, svg('foreignObject', { width, height }, body));
  const page = getComputedStyle(document.documentElement);
  for (const inset of INSETS) drawing.style.setProperty(inset, page.getPropertyValue(inset));
  const xml = new XMLSerializer().serializeToString(drawing).replace(NOT_XML, '');
  const image = new Image(width, height);
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(xml)}`;
  await image.decode();
  return image;
}

/** Breaks lines at spaces where they are too wide; a word that is too wide alone is broken anywhere. */
export function wrapped(lines: readonly string[], fits: (line: string) => boolean): string[] {
  return lines.flatMap((line) => {
    const rows: string[] = [];
    let row = '';
    for (const word of line.split(/(?<= )/)) {
      if (row !== '' && !fits((row + word).trimEnd())) {
        rows.push(row);
        row = '';
      }
      row += word;
      while (row.length > 1 && !fits(row.trimEnd())) {
        let count = row.length - 1;
        while (count > 1 && !fits(row.slice(0, count))) --count;
        rows.push(row.slice(0, count));
        row = row.slice(count);
      }
    }
    return [...rows, row].map((text) => text.trimEnd());
  });
}

/** `root`: fills the window. `caption`: lines of text. */
export async function pagePicture(root: HTMLElement, caption: readonly string[]): Promise<Blob> {
  const { innerWidth: width, innerHeight: height, devicePixelRatio: density } = window;
  const image = await imageOf(await copyOf(root), width, height);
  const canvas = h('canvas');
  const pen = canvas.getContext('2d')!;
  pen.font = FONT;
  const rows = wrapped(caption, (row) => pen.measureText(row).width <= width - 2 * MARGIN_PX);
  const captionHeight = rows.length * LINE_PX + 2 * MARGIN_PX;
  canvas.width = Math.round(width * density);
  canvas.height = Math.round((height + captionHeight) * density);
  pen.scale(density, density);
  pen.drawImage(image, 0, 0, width, height);
  const colour = getComputedStyle(root);
  pen.fillStyle = colour.getPropertyValue('--panel');
  pen.fillRect(0, height, width, captionHeight);
  pen.fillStyle = colour.getPropertyValue('--text');
  pen.font = FONT; // a new size resets it
  pen.textBaseline = 'middle';
  rows.forEach((row, i) => pen.fillText(row, MARGIN_PX, height + MARGIN_PX + (i + 0.5) * LINE_PX));
  return pngOf(canvas);
}
