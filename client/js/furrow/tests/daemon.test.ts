// SPDX-License-Identifier: Apache-2.0
// The built package against the real daemon, which is killed and restarted. Everything waits for events.
import assert from 'node:assert/strict';
import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import test from 'node:test';
import type * as Furrow from '../src/node.js';

const { FURROW_BIN, FURROW_SHARE, FURROW_JS } = process.env as Record<string, string>;
const FRAMES = 1000;
const SUBJECTS = ['ada', 'bob'] as const;
const RECORDING = join(FURROW_SHARE!, 'recordings/performance.bvh');
const SKIP = existsSync(join(FURROW_BIN!, 'furrowd')) ? false : 'furrowd is not built';

interface Ports {
  tcp: number;
  udp: number;
  http: number;
}

/** What a daemon that requires tokens and its clients need. Without: everybody is let in. */
interface Tokens {
  daemon: string[];
  play: string[];
  address: string;
}
const NO_TOKENS: Tokens = { daemon: [], play: [], address: '' };

function makeTokens(): Tokens {
  const folder = mkdtempSync(join(tmpdir(), 'furrow-js-'));
  const file = (name: string): string => join(folder, name);
  const furrow = (...args: string[]): void => {
    execFileSync(join(FURROW_BIN!, 'furrow'), ['token', ...args, '--key', file('keys')], { stdio: 'ignore' });
  };
  furrow('key', 'new');
  furrow('new', '--role', 'publish', '--for', '1h', '--out', file('publish'));
  furrow('new', '--role', 'watch', '--for', '1h', '--out', file('watch'));
  return {
    daemon: ['--security', 'required', '--keys', file('keys')],
    play: ['--token', file('publish')],
    address: `&token=${encodeURIComponent(file('watch'))}`,
  };
}

/** Starts furrowd, again at the same ports after a restart. */
async function startDaemon(tokens: Tokens, ports: Ports = { tcp: 0, udp: 0, http: 0 }): Promise<{ process: ChildProcess; ports: Ports }> {
  const listen = Object.entries(ports).flatMap(([name, port]) => [`--${name}`, String(port)]);
  const child = spawn(join(FURROW_BIN!, 'furrowd'), ['--no-render', ...listen, ...tokens.daemon], { stdio: ['ignore', 'pipe', 'ignore'] });
  let out = '';
  const ready = await new Promise<string>((resolve, reject) => {
    child.stdout.on('data', (text) => {
      out += String(text);
      const line = /^furrowd ready .*$/m.exec(out);
      if (line !== null) resolve(line[0]);
    });
    child.on('exit', (code) => reject(new Error(`furrowd ended with ${String(code)}: ${out}`)));
  });
  const port = (name: string): number => Number(new RegExp(`${name}=\\S*?:(\\d+)`).exec(ready)![1]);
  return { process: child, ports: { tcp: port('tcp'), udp: port('udp'), http: port('http') } };
}

function play(subject: string, tokens: Tokens, ports: Ports): ChildProcess {
  return spawn(join(FURROW_BIN!, 'furrow'), ['play', RECORDING, '--to', `127.0.0.1:${ports.udp}`, '--udp', '--subject', subject,
    '--loop', '--speed', '4', ...tokens.play], { stdio: 'ignore' });
}

async function kill(child: ChildProcess): Promise<void> {
  if (child.exitCode !== null || child.signalCode !== null) return;
  const ended = once(child, 'exit');
  child.kill('SIGKILL');
  await ended;
}

/** Resolves when `holds`, which is asked at every event of the client. */
function until(client: Furrow.Client, holds: () => boolean): Promise<void> {
  return new Promise((resolve) => {
    const removers: (() => void)[] = [];
    const ask = (): void => {
      if (!holds()) return;
      for (const remove of removers) remove();
      resolve();
    };
    for (const event of ['weights', 'pose', 'state', 'layout', 'gone'] as const) removers.push(client.on(event, ask));
    ask();
  });
}

async function follow(client: Furrow.Client): Promise<void> {
  const numbers = new Map<string, number>();
  client.on('weights', ({ subject, number, values, names }) => {
    assert.equal(number, (numbers.get(subject) ?? 0) + 1, 'no frame is reported twice or left out');
    assert.equal(values.length, names.length);
    numbers.set(subject, number);
  });
  await until(client, () => SUBJECTS.every((subject) => (numbers.get(subject) ?? 0) >= FRAMES && client.pose(subject) !== null));
}

async function surviveRestart(kind: 'udp' | 'tcp' | 'ws', tokens: Tokens, context: test.TestContext): Promise<void> {
  const { open, openWebSocket } = await import(pathToFileURL(join(FURROW_JS!, 'furrow/dist/node.js')).href) as typeof Furrow;
  const children: ChildProcess[] = [];
  context.after(() => Promise.all(children.map(kill)));
  const first = await startDaemon(tokens);
  children.push(first.process, ...SUBJECTS.map((subject) => play(subject, tokens, first.ports)));
  const port = { udp: first.ports.udp, tcp: first.ports.tcp, ws: first.ports.http }[kind];
  const address = `furrow://127.0.0.1:${port}?subject=ada&subject=bob${kind === 'tcp' ? '&transport=tcp' : ''}${tokens.address}`;
  const client = (kind === 'ws' ? openWebSocket : open)(address, { poses: true });
  context.after(() => client.close());

  await follow(client);
  assert.equal(client.malformed, 0);
  const before = client.weights('ada')!;
  assert(before.names.includes('brow_l.squash'));
  assert.deepEqual(client.names('bob'), before.names);
  const pose = client.pose('bob')!;
  assert.equal(pose.rotations.length, 4 * pose.skeleton.names.length);

  await kill(first.process);
  await until(client, () => client.state !== 'connected' || kind === 'udp'); // UDP notices by the next ping
  const after = { ada: client.weights('ada')!.number, bob: client.weights('bob')!.number };
  const connects = client.connects;
  const second = await startDaemon(tokens, first.ports);
  children.push(second.process);
  const readyMs = performance.now();
  await until(client, () => client.connects > connects);
  const connectedMs = performance.now() - readyMs;
  await until(client, () => SUBJECTS.every((subject) => client.weights(subject)!.number > after[subject]));
  context.diagnostic(`${kind}: connected ${connectedMs.toFixed(0)} ms and weights ` +
    `${(performance.now() - readyMs).toFixed(0)} ms after the daemon was ready again`);
  assert.equal(client.weights('ada')!.layout, before.layout);
}

test(`${FRAMES} frames of two subjects, and more after the daemon was killed`, { skip: SKIP, concurrency: true }, async (context) => {
  await Promise.all((['udp', 'tcp', 'ws'] as const).map((kind) => context.test(kind, (inner) => surviveRestart(kind, NO_TOKENS, inner))));
});

test('the same with tokens', { skip: SKIP, concurrency: true }, async (context) => {
  const tokens = makeTokens();
  await Promise.all((['udp', 'tcp', 'ws'] as const).map((kind) => context.test(kind, (inner) => surviveRestart(kind, tokens, inner))));
});

test('a daemon that requires tokens says so', { skip: SKIP }, async (context) => {
  const { open, openWebSocket } = await import(pathToFileURL(join(FURROW_JS!, 'furrow/dist/node.js')).href) as typeof Furrow;
  const { process: daemon, ports } = await startDaemon(makeTokens());
  context.after(() => kill(daemon));
  for (const transport of ['udp', 'tcp'] as const) {
    const client = open(`furrow://127.0.0.1:${ports[transport]}?transport=${transport}`);
    const [, problem, message] = await new Promise<[string, string, string]>((resolve) => {
      client.on('problem', (...args) => resolve(args));
    });
    client.close();
    assert.equal(problem, 'needs-token');
    assert.match(message, /requires a token/);
  }
  // The token of another daemon's keys.
  const foreign = makeTokens().address;
  for (const [client, why] of [
    [open(`furrow://127.0.0.1:${ports.udp}?subject=a${foreign}`), /does not have the key/],
    [openWebSocket(`furrow://127.0.0.1:${ports.http}?subject=a${foreign}`), /refuses the one/],
  ] as const) {
    while (!why.test(client.lastFailure)) await new Promise((resolve) => setTimeout(resolve, 10)); // no event tells
    client.close();
  }
});
