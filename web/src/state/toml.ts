// SPDX-License-Identifier: Apache-2.0
// Settings as TOML, in the subset of `furrowd --render-settings`: one level of tables, strings, numbers,
// booleans, and arrays of strings or numbers.
import type { SettingInfo } from '../api';
import { isOn, type Values } from './settings';

function tomlValue(info: SettingInfo, text: string): string {
  switch (info.kind) {
    case 'bool':
      return isOn(text) ? 'true' : 'false';
    case 'choice':
      return JSON.stringify(text);
    case 'colour':
      return `[${text.split(',').map((part) => part.trim()).join(', ')}]`;
    case 'list':
      return JSON.stringify(text === '' ? [] : text.split(','));
    default:
      return text;
  }
}

/** Writes the settings in `infos`. Settings without a table come first, as TOML requires. */
export function toToml(infos: readonly SettingInfo[], values: Values): string {
  const tables = new Map<string, string[]>([['', []]]);
  for (const info of infos) {
    const text = values.get(info.name);
    if (text === undefined) continue;
    const dot = info.name.indexOf('.');
    const table = dot < 0 ? '' : info.name.slice(0, dot);
    if (!tables.has(table)) tables.set(table, []);
    const unit = info.unit === '' ? '' : `  # ${info.unit}`;
    tables.get(table)!.push(`${info.name.slice(dot + 1)} = ${tomlValue(info, text)}${unit}`);
  }
  const parts: string[] = [];
  for (const [table, lines] of tables) {
    if (lines.length > 0) parts.push([...(table === '' ? [] : [`[${table}]`]), ...lines].join('\n'));
  }
  return parts.length === 0 ? '' : `${parts.join('\n\n')}\n`;
}

export class TomlError extends Error {}

/** Removes a comment: everything from a '#' outside quotes. */
function withoutComment(line: string): string {
  let quoted = false;
  for (let i = 0; i < line.length; ++i) {
    if (line[i] === '"') quoted = !quoted;
    else if (line[i] === '#' && !quoted) return line.slice(0, i).trim();
  }
  return line.trim();
}

function plainValue(toml: string): string | null {
  if (toml.startsWith('"') || toml.startsWith('[')) {
    try {
      const parsed: unknown = JSON.parse(toml.replace(/,\s*\]$/, ']'));
      if (typeof parsed === 'string') return parsed;
      return Array.isArray(parsed) ? parsed.join(',') : null;
    } catch {
      return null;
    }
  }
  if (toml === 'true') return 'on';
  if (toml === 'false') return 'off';
  return /^[+-]?[\d_]+(\.\d+)?([eE][+-]?\d+)?$/.test(toml) ? toml.replaceAll('_', '') : null;
}

/** Returns values by name, in the daemon's text form. Throws a TomlError that names the line. */
export function fromToml(text: string): Map<string, string> {
  const values = new Map<string, string>();
  let table = '';
  text.split('\n').forEach((raw, index) => {
    const line = withoutComment(raw);
    if (line === '') return;
    const header = /^\[([\w.]+)\]$/.exec(line);
    if (header) {
      table = `${header[1]}.`;
      return;
    }
    const pair = /^([\w.]+)\s*=\s*(.+)$/.exec(line);
    const value = pair ? plainValue(pair[2]!) : null;
    if (!pair || value === null) {
      throw new TomlError(`Line ${index + 1}: "${line}" must be name = value, with strings in quotes`);
    }
    values.set(table + pair[1]!, value);
  });
  return values;
}
