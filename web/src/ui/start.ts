// SPDX-License-Identifier: Apache-2.0
// main.ts imports this before the rest of the page: what other modules need from the browser when they are loaded, and
// the message for a browser in which they fail.
import { text } from '../text';
import { h } from './dom';

// Systems without a locale call their language "C", which Intl rejects.
try {
  new Intl.NumberFormat(navigator.language);
} catch {
  Object.defineProperty(navigator, 'language', { value: 'en' });
}

// The page replaces the placeholder when it has been built. Later errors leave it as it is.
window.addEventListener('error', ({ message }) => {
  if (document.querySelector('body > .placeholder') === null) return;
  document.body.replaceChildren(h('div', { class: 'failed', role: 'alert' }, h('p', {}, text.app.failed(message)),
    h('img', { src: 'mjpeg', alt: text.app.failedPicture })));
});
