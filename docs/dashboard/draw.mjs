// SPDX-License-Identifier: Apache-2.0
// Usage: draw.mjs DASHBOARD.json SERIES.json OUT.png
// Draws the dashboard nearly as Grafana lays it out, from what its queries returned, so that it can be judged where there is no
// Grafana. SERIES.json: {"PANEL ID": [{"target": NUMBER, "labels": {...}, "values": [[UNIX SECONDS, "VALUE"], ...]}]}, as
// tests/deploy/test_dashboard.py saves it.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { launch } from '../../tests/browser/browser.mjs';

const plots = fileURLToPath(new URL('../../web/node_modules/uplot/dist/', import.meta.url));

const [dashboardFile, seriesFile, out] = process.argv.slice(2);
const dashboard = JSON.parse(readFileSync(dashboardFile, 'utf8'));
const found = JSON.parse(readFileSync(seriesFile, 'utf8'));

const panels = dashboard.panels.map((panel) => ({
  ...panel,
  series: (found[panel.id] ?? []).map(({ target, labels, values }) => ({
    name: panel.targets[target].legendFormat.replace(/{{(\w+)}}/g, (_, label) => labels[label] ?? ''),
    values: values.map(([at, value]) => [at, Number(value)]),
  })),
}));

/** Runs in the page. */
function draw(shown) {
  const ROW = 36, WIDTH = 1600;
  const NAMED = { green: '#73bf69', orange: '#ff9830', red: '#f2495c' };
  const COLOURS = ['#73bf69', '#f2cc0c', '#5794f2', '#ff9830', '#f2495c', '#b877d9'];
  const scaled = (value, base, units) => {
    let i = 0;
    while (i + 1 < units.length && Math.abs(value) >= base) { value /= base; ++i; }
    return `${Number(value.toPrecision(3))} ${units[i]}`;
  };
  const words = (value, unit) => {
    if (value === null || Number.isNaN(value)) return '';
    if (unit === 's') return value === 0 ? '0 s' : value < 1 ? scaled(value * 1e6, 1000, ['µs', 'ms', 's']) : scaled(value, 60, ['s', 'min']);
    if (unit === 'bytes') return scaled(value, 1024, ['B', 'KiB', 'MiB', 'GiB']);
    const short = scaled(value, 1000, ['', 'K', 'M']).trim();
    return unit === 'pps' ? `${short} p/s` : unit.startsWith('suffix:') ? short + unit.slice(7) : short;
  };
  const element = (parent, css, text = '') => {
    const made = parent.appendChild(document.createElement('div'));
    made.style.cssText = css;
    made.textContent = text;
    return made;
  };
  const stat = (box, panel, unit) => {
    const [first] = panel.series;
    const last = first?.values.at(-1)?.[1];
    const mapped = (panel.fieldConfig.defaults.mappings ?? [])[0]?.options[last];
    const text = first === undefined ? 'No data' : mapped?.text ?? (panel.options.textMode === 'name' ? first.name : words(last, unit));
    element(box, `font-size:30px; text-align:center; margin-top:22px; color:${NAMED[mapped?.color ?? 'green']}`, text);
  };
  const plot = (box, panel, unit, width, height) => {
    const times = [...new Set(panel.series.flatMap(({ values }) => values.map(([at]) => at)))].sort((a, b) => a - b);
    const data = panel.series.map(({ values }) => {
      const known = new Map(values);
      return times.map((at) => (Number.isFinite(known.get(at)) ? known.get(at) : null));
    });
    const axis = { stroke: '#ccccdc', grid: { stroke: '#2c3235', width: 1 }, ticks: { show: false }, font: '11px sans-serif' };
    const legend = panel.series.length * 17;
    new uPlot({
      width, height: height - legend, legend: { show: false }, cursor: { show: false },
      scales: { y: { range: (_, __, high) => [0, high > 0 ? high * 1.1 : 1] } },
      axes: [axis, { ...axis, size: 66, values: (_, ticks) => ticks.map((value) => words(value, unit)) }],
      series: [{}, ...panel.series.map((_, i) => ({ stroke: COLOURS[i], width: 1, fill: `${COLOURS[i]}18`, points: { show: false } }))],
    }, [times, ...data], box);
    panel.series.forEach(({ name }, i) => {
      const line = element(box, 'font-size:12px; height:17px; white-space:nowrap; overflow:hidden; padding-left:10px');
      element(line, `display:inline-block; width:14px; height:3px; margin:0 6px 3px 0; background:${COLOURS[i]}`);
      line.append(name);
    });
  };
  document.body.style.cssText = `margin:0; background:#111217; color:#ccccdc; font-family:sans-serif; position:relative; width:${WIDTH}px`;
  let bottom = 0;
  for (const panel of shown) {
    const { x, y, w, h } = panel.gridPos;
    const width = (w * WIDTH) / 24 - 8, height = h * ROW - 8;
    bottom = Math.max(bottom, (y + h) * ROW);
    const place = `position:absolute; left:${(x * WIDTH) / 24 + 4}px; top:${y * ROW + 4}px; width:${width}px; height:${height}px;`;
    if (panel.type === 'row') {
      element(document.body, `${place} font-size:17px; line-height:28px`, panel.title);
      continue;
    }
    const box = element(document.body, `${place} background:#181b1f; border:1px solid #2c3235; box-sizing:border-box; overflow:hidden`);
    element(box, 'font-size:14px; padding:6px 10px; height:18px', panel.title);
    const { unit } = panel.fieldConfig.defaults;
    if (panel.type === 'stat') stat(box, panel, unit);
    else plot(box, panel, unit, width, height - 34);
  }
  document.body.style.height = `${bottom}px`;
}

const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1600, height: 900 } });
await page.addStyleTag({ path: `${plots}uPlot.min.css` });
await page.addScriptTag({ path: `${plots}uPlot.iife.min.js` });
await page.evaluate(draw, panels);
await page.screenshot({ path: out, fullPage: true });
await browser.close();
