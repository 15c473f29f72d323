// SPDX-License-Identifier: Apache-2.0
// Watches the subject "ada" over a WebSocket and prints the number of each pose: follow.mjs PACKAGES HOST:PORT
const [packages, address] = process.argv.slice(2);
const { openWebSocket } = await import(`${packages}/furrow/dist/node.js`);
const client = openWebSocket(`furrow://${address}?subject=ada`);
let last = -1;
client.on('weights', ({ sequence }) => {
  if (sequence !== last) console.log(sequence); // decaying weights repeat it
  last = sequence;
});
