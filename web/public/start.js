// SPDX-License-Identifier: Apache-2.0
// Runs before the page's module, and in browsers that cannot read the module, so it uses no new syntax.
(function () {
  'use strict';
  // Systems without a locale call their language "C", which Intl rejects.
  try {
    new Intl.NumberFormat(navigator.language);
  } catch (error) {
    Object.defineProperty(navigator, 'language', { value: 'en' });
  }

  // Errors of a page that has been built leave it as it is.
  window.addEventListener('error', function (event) {
    if (!event.message || document.querySelector('body > .app')) return;
    var words = document.createElement('p');
    words.textContent = 'This browser cannot run the page: ' + event.message +
      '. A browser of the last two years can. Below is the live picture alone.';
    var picture = document.createElement('img');
    picture.src = 'mjpeg';
    picture.alt = 'Live picture';
    var all = document.createElement('div');
    all.className = 'failed';
    all.setAttribute('role', 'alert');
    all.appendChild(words);
    all.appendChild(picture);
    document.body.textContent = '';
    document.body.appendChild(all);
  });
})();
