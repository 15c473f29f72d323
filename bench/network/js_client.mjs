// SPDX-License-Identifier: Apache-2.0
// Prints the sequence of each frame that the package `furrow` receives in Node.
//   js_client.mjs PACKAGE ADDRESS        PACKAGE: the folder dist of the built package
import { pathToFileURL } from 'node:url';

const [folder, address] = process.argv.slice(2);
const { open } = await import(pathToFileURL(`${folder}/node.js`).href);
open(address).on('weights', (frame) => {
  if (frame.ageMs < 100) console.log(frame.sequence);
});
