// SPDX-License-Identifier: Apache-2.0
// Serves the built npm packages and the data of the build to a page, as any web server would.
import { createServer } from 'node:http';
import { once } from 'node:events';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';

const TYPES = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.json': 'application/json' };
const FOLDERS = { '/share/': process.env.FURROW_SHARE, '/': process.env.FURROW_JS };

/** `pages`: HTML by path, beside the folders. Returns the address and a function that ends the server. */
export async function serveModules(pages = {}) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname)).replace(/\/$/, '/index.html');
    const [prefix, folder] = Object.entries(FOLDERS).find(([start]) => path.startsWith(start));
    try {
      const body = pages[path] ?? await readFile(join(folder, path.slice(prefix.length)));
      response.setHeader('Content-Type', pages[path] ? TYPES['.html'] : TYPES[extname(path)] ?? 'application/octet-stream');
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
