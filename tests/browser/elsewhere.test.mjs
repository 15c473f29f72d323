// SPDX-License-Identifier: Apache-2.0
// Two daemons of a cluster: the page goes to the one that serves its subject.
import assert from 'node:assert/strict';
import { createServer } from 'node:net';
import { after, before, test } from 'node:test';
import { launch, openPage } from './browser.mjs';
import { Daemon, furrow, recording } from './daemon.mjs';

let browser;

/** Listens until the end of this process; null: the port is taken. */
function listen(port) {
  return new Promise((resolve) => {
    const server = createServer().on('error', () => resolve(null));
    server.listen(port, '127.0.0.1', () => resolve(server.unref()));
  });
}

/**
 * Ports that nobody uses, among those that the system gives to nobody. Other tests leave them alone, because this
 * process holds the ports 12,000 below (as free_port() in tests/end_to_end/furrow_testing.py does).
 */
async function freePorts(count) {
  const ports = new Set();
  while (ports.size < count) {
    const port = 20_000 + Math.floor(12_000 * Math.random());
    const guard = await listen(port - 12_000);
    if (guard === null) continue;
    const probe = await listen(port);
    if (probe === null) {
      guard.close();
      continue;
    }
    await new Promise((resolve) => probe.close(resolve));
    ports.add(port);
  }
  return [...ports];
}

before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test('the page goes to the daemon that serves its subject, with its settings', async () => {
  const all = await freePorts(6);
  const [a, b] = [all.slice(0, 3), all.slice(3)].map(([tcp, udp, http]) => ({ tcp, udp, http }));
  const list = [['a', a], ['b', b]].flatMap(([name, { tcp, udp, http }]) => ['--cluster-node', `${name}=127.0.0.1:${tcp}:${udp}:${http}`]);
  const daemons = await Promise.all([['a', a], ['b', b]].map(([name, ports]) => Daemon.start(['--no-render', '--name', name, ...list], ports)));
  let performer;
  try {
    const { node } = await daemons[0].get('api/place?subject=ada');
    const [there, here] = node === 'a' ? daemons : [daemons[1], daemons[0]];
    performer = furrow('play', recording('performance'), '--to', `127.0.0.1:${there.ports.udp}`, '--udp', '--subject', 'ada', '--loop');
    const page = await openPage(browser, `${here.address}#subject=ada&curves=brow_l.squash`);
    await page.waitForURL(`${there.address}#*`);
    const hash = new URLSearchParams(new URL(page.url()).hash.slice(1));
    assert.deepEqual([hash.get('subject'), hash.get('curves')], ['ada', 'brow_l.squash']);
    // The page that it came from stays in the history.
    const visited = [];
    page.on('framenavigated', (frame) => visited.push(new URL(frame.url()).port));
    await page.goBack({ waitUntil: 'commit' });
    assert.equal(visited[0], String(here.ports.http));
    // A page without a chosen subject stays where it is.
    const other = await openPage(browser, here.address);
    await other.waitForSelector('.condition');
    assert.equal(new URL(other.url()).port, String(here.ports.http));
    await page.context().close();
    await other.context().close();
  } finally {
    performer?.kill();
    await Promise.all(daemons.map((daemon) => daemon.stop()));
  }
});
