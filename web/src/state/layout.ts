// SPDX-License-Identifier: Apache-2.0
// How the page arranges itself. On small screens, panels become sheets below or beside the picture, one at a time.
import { Signal } from '../ui/signal';

export const COMPACT = '(max-width: 900px), (max-height: 500px)';

/** True on small screens. */
export const isCompact = new Signal(false);

if (typeof matchMedia === 'function') {
  const query = matchMedia(COMPACT);
  isCompact.set(query.matches);
  query.addEventListener('change', () => isCompact.set(query.matches));
}
