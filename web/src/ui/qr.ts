// SPDX-License-Identifier: Apache-2.0
import { svg } from './dom';

/** Modules of light around the code, which readers need. */
const QUIET = 4;

/** A QR code of a text, as a picture with this name for screen readers. Its library is loaded when it is first needed. */
export async function qrCode(content: string, name: string): Promise<SVGSVGElement> {
  const { default: qrcode } = await import('qrcode-generator');
  const code = qrcode(0, 'M');
  code.addData(content);
  code.make();
  const count = code.getModuleCount();
  let dark = '';
  for (let row = 0; row < count; ++row) {
    for (let column = 0; column < count; ++column) {
      if (code.isDark(row, column)) dark += `M${column + QUIET} ${row + QUIET}h1v1h-1z`;
    }
  }
  const size = count + 2 * QUIET;
  return svg('svg', { viewBox: `0 0 ${size} ${size}`, class: 'qr', role: 'img', 'aria-label': name, 'shape-rendering': 'crispEdges' },
    svg('rect', { width: size, height: size, fill: '#fff' }), svg('path', { d: dark, fill: '#000' }));
}
