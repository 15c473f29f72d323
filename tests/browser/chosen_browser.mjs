// SPDX-License-Identifier: Apache-2.0
// The browser in which the tests open the page: Debian's Chromium, or Debian's Firefox with FURROW_BROWSER=firefox.
export const IS_FIREFOX = process.env.FURROW_BROWSER === 'firefox';
export const EXECUTABLE = IS_FIREFOX ? '/usr/bin/firefox-esr' : '/usr/bin/chromium';
