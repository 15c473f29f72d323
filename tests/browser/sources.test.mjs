// SPDX-License-Identifier: Apache-2.0
// Phones and trackers: where they send to, what has arrived, and what blocks it.
import assert from 'node:assert/strict';
import { createSocket } from 'node:dgram';
import { networkInterfaces } from 'node:os';
import { after, before, test } from 'node:test';
import { eventually, keep, launch, openPage } from './browser.mjs';
import { Daemon } from './daemon.mjs';
import { liveLinkFace } from './support/live_link_face.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** One frame of VMC that raises a shape. */
function* vmc(value) {
  const text = (words) => Buffer.from(words + '\0'.repeat(4 - (words.length % 4)));
  const number = (write, what) => { const bytes = Buffer.alloc(4); bytes[write](what); return bytes; };
  yield Buffer.concat([text('/VMC/Ext/OK'), text(',i'), number('writeInt32BE', 1)]);
  yield Buffer.concat([text('/VMC/Ext/Blend/Val'), text(',sf'), text('browInnerUp'), number('writeFloatBE', value)]);
  yield Buffer.concat([text('/VMC/Ext/Blend/Apply'), text(',')]);
}

/** Sends frames of VMC from an address of this computer until stop(). */
function vmcSender(port, address) {
  const socket = createSocket('udp4');
  let timer, frame = 0;
  socket.bind(0, address, () => {
    timer = setInterval(() => { for (const packet of vmc((frame++ % 10) / 10)) socket.send(packet, port, '127.0.0.1'); }, 33);
  });
  return { stop() { clearInterval(timer); socket.close(); } };
}

/** A daemon without pictures has no cameras, which the browser reports. */
const errorsOf = (page) => page.errors.filter((error) => !error.includes('503'));
const card = (page, state) => page.locator(`[data-source=livelink_face][data-state=${state}]`);

test('on loopback, the page says why no phone gets through', async () => {
  const daemon = await Daemon.start(['--no-render', '--livelink-face', '0']);
  try {
    // The log and the ready line come by different pipes.
    await eventually('the warning', () => /--livelink-face listens on 127\.0\.0\.1 only/.test(daemon.log));
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    await card(page, 'blocked').getByText('No phone can reach it').waitFor();
    await page.locator('[data-source=vmc][data-state=off]', { hasText: '--vmc 39539' }).waitFor();
    assert.equal(await page.locator('.source-code').isVisible(), false);
    await keep(page, 'sources-loopback');
    assert.deepEqual(errorsOf(page), []);
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});

test('in a network, the page shows the address, what arrives and what is refused', async () => {
  const daemon = await Daemon.start(['--no-render', '--bind', '0.0.0.0', '--open', '--livelink-face', '0']);
  const socket = createSocket('udp4');
  let timer;
  try {
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    await card(page, 'waiting').getByText('Nothing has arrived yet').waitFor();
    const addresses = Object.values(networkInterfaces()).flat().filter(({ family, internal }) => family === 'IPv4' && !internal);
    assert.equal(await page.locator('.target code').count() > 0, addresses.length > 0);
    if (addresses.length > 0) {
      await card(page, 'waiting').getByText(String(daemon.ports.livelink_face)).waitFor();
      await page.locator('.qr').waitFor();
      assert.match(await page.locator('.qr').getAttribute('aria-label'), new RegExp(`http://.*:${daemon.ports.http}/#panel=sources`));
    }
    const send = (message) => socket.send(message, daemon.ports.livelink_face, '127.0.0.1');
    timer = setInterval(() => send(Buffer.from('GET / HTTP/1.1')), 100);
    await card(page, 'blocked').getByText('not understood').first().waitFor();
    clearInterval(timer);
    let frame = 0;
    timer = setInterval(() => send(liveLinkFace('phone', frame++)), 16);
    await card(page, 'receiving').getByText('Receiving from 127.0.0.1').waitFor();
    await keep(page, 'sources-receiving');
    clearInterval(timer);
    await card(page, 'waiting').getByText('has stopped sending').waitFor();
    assert.deepEqual(errorsOf(page), []);
    await page.context().close();
  } finally {
    clearInterval(timer);
    socket.close();
    await daemon.stop();
  }
});

test('senders that are not allowed are named', async () => {
  const daemon = await Daemon.start(['--no-render', '--livelink-face', '0', '--mocap-allow', '127.0.0.9']);
  const socket = createSocket('udp4');
  const timer = setInterval(() => socket.send(liveLinkFace('phone', 1), daemon.ports.livelink_face, '127.0.0.1'), 50);
  try {
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    await card(page, 'blocked').getByText('--mocap-allow does not list it').waitFor();
    await card(page, 'blocked').getByText('--mocap-allow 127.0.0.1').waitFor();
    await page.context().close();
  } finally {
    clearInterval(timer);
    socket.close();
    await daemon.stop();
  }
});

test('a sender that another one keeps out is accepted by a click', async () => {
  const daemon = await Daemon.start(['--no-render', '--rig', 'arkit', '--vmc', '0']);
  const senders = [vmcSender(daemon.ports.vmc, '127.0.0.1')];
  try {
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    const receiving = page.locator('[data-source=vmc][data-state=receiving]');
    await receiving.getByText('Receiving from 127.0.0.1').waitFor();
    senders.push(vmcSender(daemon.ports.vmc, '127.0.0.2'));
    const row = page.locator('[data-stream=vmc]');
    await row.getByText('VMC').waitFor();
    await row.locator('summary').click();
    await row.getByText('The rig reads these blend shapes, and the stream does not have them').waitFor();
    const accept = receiving.getByRole('button', { name: 'Accept 127.0.0.2 instead' });
    await accept.waitFor();
    await keep(page, 'sources-refused');
    await accept.click();
    await receiving.getByText('Receiving from 127.0.0.2').waitFor();
    await receiving.getByRole('button', { name: 'Accept 127.0.0.1 instead' }).waitFor();
    assert.equal(await row.locator('details').getAttribute('open'), '', 'the list stays open');
    assert.deepEqual(errorsOf(page), []);
    await page.context().close();
  } finally {
    senders.forEach((sender) => sender.stop());
    await daemon.stop();
  }
});
