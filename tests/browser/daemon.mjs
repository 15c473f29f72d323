// SPDX-License-Identifier: Apache-2.0
// The programs under test: furrowd on ports of its own, and furrow beside it.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';

const BIN = process.env.FURROW_BIN;
export const SHARE = process.env.FURROW_SHARE;
export const recording = (name) => join(SHARE, 'recordings', `${name}.bvh`);

/** Without a GPU, pictures of skin and large textures take several times longer, and most tests are about other things. */
const LIGHT = process.env.FURROW_LIGHT_CHARACTER;
const PLAIN = join(mkdtempSync(join(tmpdir(), 'furrow-browser-')), 'plain.toml');
writeFileSync(PLAIN, 'shading = "diffuse"\n');
process.on('exit', () => rmSync(dirname(PLAIN), { recursive: true, force: true }));

/** Starts a furrowd. `ports` of a former daemon make it reuse the same addresses. */
export class Daemon {
  static start(options = [], ports = undefined) {
    const who = options.some((option) => option === '--character' || option === '--rig') ? [] : ['--character', LIGHT];
    return Daemon.startAsShipped(['--render-settings', PLAIN, ...who, ...options], ports);
  }

  /** With the character and the look that viewers see first. */
  static async startAsShipped(options = [], ports = { tcp: 0, udp: 0, http: 0 }) {
    const listen = Object.entries(ports).filter(([name]) => ['tcp', 'udp', 'http'].includes(name))
      .flatMap(([name, port]) => [`--${name}`, String(port)]);
    const child = spawn(join(BIN, 'furrowd'), [...listen, ...options], { stdio: ['ignore', 'pipe', 'pipe'] });
    const daemon = new Daemon(child);
    child.stderr.on('data', (text) => (daemon.log += text));
    const ready = await new Promise((resolve, reject) => {
      let out = '';
      child.stdout.on('data', (text) => {
        out += text;
        const line = /^furrowd ready .*$/m.exec(out);
        if (line !== null) resolve(line[0]);
      });
      child.on('exit', (code) => reject(new Error(`furrowd ended with ${code}:\n${daemon.log}`)));
    });
    const optional = ['livelink_face', 'vmc'];
    for (const name of ['tcp', 'udp', 'http', ...optional]) {
      const port = new RegExp(`${name}=\\S*?:(\\d+)`).exec(ready)?.[1];
      if (port === undefined && optional.includes(name)) continue;
      if (port === undefined) throw new Error(`no ${name} port in: ${ready}`);
      daemon.ports[name] = Number(port);
    }
    return daemon;
  }

  constructor(child) {
    this.child = child;
    this.log = '';
    this.ports = {};
  }

  get address() {
    return `http://127.0.0.1:${this.ports.http}/`;
  }

  /** Asks again as long as the daemon says that this host asks too often, as pages and tests of a busy computer do. */
  async ask(path, options = {}) {
    for (;;) {
      const response = await fetch(this.address + path, options);
      if (response.status !== 429) return response;
      await new Promise((resolve) => setTimeout(resolve, 1000 * Number(response.headers.get('retry-after'))));
    }
  }

  async get(path) {
    return (await this.ask(path)).json();
  }

  async patch(path, body) {
    const response = await this.ask(path, {
      method: 'PATCH', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body),
    });
    if (!response.ok) throw new Error(`${path}: ${response.status} ${await response.text()}`);
    return response.json();
  }

  /** Pauses the recording of --play at this second. */
  async hold(seconds) {
    await this.patch('api/playback', { playing: false, position_s: seconds });
  }

  async stop(signal = 'SIGTERM') {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return;
    this.child.removeAllListeners('exit');
    const ended = once(this.child, 'exit');
    this.child.kill(signal);
    await ended;
  }
}

/** Starts `furrow ARGS...` and returns the process, which the caller stops with kill(). */
export function furrow(...args) {
  return spawn(join(BIN, 'furrow'), args, { stdio: ['ignore', 'pipe', 'inherit'] });
}

/** Runs `furrow ARGS...` and returns its output. Fails if it exits with an error. */
export async function furrowOutput(...args) {
  const child = furrow(...args);
  let out = '';
  child.stdout.on('data', (text) => (out += text));
  const [code] = await once(child, 'exit');
  if (code !== 0) throw new Error(`furrow ${args.join(' ')}: exit code ${code}`);
  return out;
}
