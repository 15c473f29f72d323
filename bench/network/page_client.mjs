// SPDX-License-Identifier: Apache-2.0
// Prints a line per frame of weights that the page of a daemon receives in Chromium.
//   page_client.mjs ADDRESS [TOKEN]      TOKEN: a file
import { readFileSync } from 'node:fs';
import { launch, openPage } from '../../tests/browser/browser.mjs';

const [address, tokenFile] = process.argv.slice(2);
const token = tokenFile ? readFileSync(tokenFile, 'utf8').trim() : '';
const browser = await launch();
for (const signal of ['SIGINT', 'SIGTERM']) process.on(signal, () => browser.close().then(() => process.exit()));
await openPage(browser, address, { ignoreHTTPSErrors: true }, async (page) => {
  if (token) await page.addInitScript((text) => sessionStorage.setItem('furrow.token', text), token);
  page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (payload.subarray?.(36, 40).toString('latin1') === 'FWGT') console.log(payload.readUInt32LE(16));
  }));
});
