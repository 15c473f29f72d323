#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Makes a character package small enough for browsers: one .glb file with its wrinkle rig, of at most 4 MB.
//
//   pack_character.mjs IN.glb OUT.glb
//
// - Vertices: directions, UVs and skin weights in 8 or 16 bits (KHR_mesh_quantization); positions as multiples of 1/65536
//   metres, which compress well on the way (gzip).
// - Pictures: JPEG, at most 1,024 pixels per side, by oiiotool (Debian: openimageio-tools). Pictures with an alpha channel
//   stay as they are: masks use it as a fourth mask. Pictures that three.js does not draw are left out.
// - The rig, IN.rig.json, becomes the scene extra `furrow_rig`.
// - The scene extra `furrow_source` holds sizes and checksums of both files, from which furrowd sees that the package is
//   outdated (character/package/web_package.h).
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { withoutComments } from '../src/rig/json_comments.js';

const LIMIT_BYTES = 4_000_000;
const SIDES = [1024, 768, 512, 384, 256]; // pixels; the first with which the file is small enough
const QUALITY = 80; // percent
const GRID = 65536; // positions per metre
const COMPONENT = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const SIZE = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

function fail(message) {
  throw new Error(message);
}

function readGlb(path) {
  const file = readFileSync(path);
  if (file.length < 20 || file.toString('latin1', 0, 4) !== 'glTF') fail(`${path} is not a .glb file`);
  const jsonBytes = file.readUInt32LE(12);
  const json = JSON.parse(file.toString('utf8', 20, 20 + jsonBytes));
  return { json, binary: file.subarray(28 + jsonBytes) };
}

class Reader {
  constructor({ json, binary }) {
    this.json = json;
    this.binary = binary;
  }

  view(index) {
    const { byteOffset = 0, byteLength } = this.json.bufferViews[index];
    return this.binary.subarray(byteOffset, byteOffset + byteLength);
  }

  /** The values of an accessor without sparse parts, tightly packed, as Furrow writes them. */
  values(index) {
    const { bufferView, byteOffset = 0, componentType, count, type } = this.json.accessors[index];
    const Values = COMPONENT[componentType];
    const bytes = this.view(bufferView);
    const copy = bytes.buffer.slice(bytes.byteOffset + byteOffset, bytes.byteOffset + byteOffset + count * SIZE[type] * Values.BYTES_PER_ELEMENT);
    return new Values(copy);
  }
}

class Writer {
  constructor() {
    this.parts = [];
    this.size = 0;
    this.views = [];
    this.accessors = [];
  }

  addView(bytes, extra = {}) {
    const padding = (4 - (this.size % 4)) % 4;
    this.parts.push(Buffer.alloc(padding), bytes);
    this.size += padding + bytes.length;
    this.views.push({ buffer: 0, byteOffset: this.size - bytes.length, byteLength: bytes.length, ...extra });
    return this.views.length - 1;
  }

  addAccessor(values, stride, accessor, target) {
    const bytes = Buffer.from(values.buffer, values.byteOffset, values.byteLength);
    const bufferView = this.addView(bytes, { ...(stride ? { byteStride: stride } : {}), ...(target ? { target } : {}) });
    this.accessors.push({ bufferView, ...accessor });
    return this.accessors.length - 1;
  }
}

/** Numbers in [-1, 1] as bytes, padded to four per vertex. */
function toBytes(values, per) {
  const packed = new Int8Array((values.length / per) * 4);
  values.forEach((value, i) => {
    packed[Math.floor(i / per) * 4 + (i % per)] = Math.round(Math.max(-1, Math.min(1, value)) * 127);
  });
  return packed;
}

/** Skin weights as bytes that sum to 255. */
function toWeights(values) {
  const packed = new Uint8Array(values.length);
  for (let v = 0; v < values.length; v += 4) {
    const four = [0, 1, 2, 3].map((k) => Math.round(values[v + k] * 255));
    const strongest = four.indexOf(Math.max(...four));
    four[strongest] += 255 - four.reduce((sum, each) => sum + each, 0);
    packed.set(four, v);
  }
  return packed;
}

function addAttributes(reader, writer, attributes) {
  const target = 34962;
  const out = {};
  for (const [name, index] of Object.entries(attributes)) {
    const { count, type, componentType } = reader.json.accessors[index];
    const values = reader.values(index);
    if (name === 'POSITION') {
      const rounded = values.map((value) => Math.round(value * GRID) / GRID);
      const axis = (k) => rounded.filter((_, i) => i % 3 === k);
      const limits = (pick) => [0, 1, 2].map((k) => axis(k).reduce((a, b) => pick(a, b)));
      out[name] = writer.addAccessor(rounded, 12, { componentType: 5126, count, type, min: limits(Math.min), max: limits(Math.max) }, target);
    } else if (name === 'NORMAL' || name === 'TANGENT') {
      out[name] = writer.addAccessor(toBytes(values, SIZE[type]), 4, { componentType: 5120, normalized: true, count, type }, target);
    } else if (name.startsWith('TEXCOORD') && values.every((value) => value >= 0 && value <= 1)) {
      out[name] = writer.addAccessor(Uint16Array.from(values, (value) => Math.round(value * 65535)), 4, { componentType: 5123, normalized: true, count, type }, target);
    } else if (name.startsWith('WEIGHTS')) {
      out[name] = writer.addAccessor(toWeights(values), 4, { componentType: 5121, normalized: true, count, type }, target);
    } else {
      out[name] = writer.addAccessor(values, 0, { componentType, count, type }, target);
    }
  }
  return out;
}

/** Copies an accessor as it is, with its sparse part. */
function copyAccessor(reader, writer, index, target) {
  const accessor = structuredClone(reader.json.accessors[index]);
  const copyView = (view) => writer.addView(reader.view(view), target ? { target } : {});
  if (accessor.bufferView !== undefined) accessor.bufferView = copyView(accessor.bufferView);
  if (accessor.sparse) {
    accessor.sparse.indices.bufferView = copyView(accessor.sparse.indices.bufferView);
    accessor.sparse.values.bufferView = copyView(accessor.sparse.values.bufferView);
  }
  writer.accessors.push(accessor);
  return writer.accessors.length - 1;
}

/** Names of the pictures that the rig needs. */
function rigPictures(rig) {
  const names = new Set();
  for (const { mask } of rig.regions ?? []) if (mask?.texture) names.add(mask.texture);
  for (const map of rig.wrinkle_maps ?? []) for (const key of ['normal', 'derivative', 'colour', 'cavity']) if (map[key]) names.add(map[key]);
  return names;
}

/** A picture with alpha keeps its bytes: oiiotool would multiply its colours by it. */
function hasAlpha(png) {
  return png.toString('latin1', 1, 4) === 'PNG' && (png[25] === 4 || png[25] === 6);
}

function shrink(bytes, side, folder, options) {
  const from = join(folder, 'in.png');
  const to = join(folder, 'out.jpg');
  writeFileSync(from, bytes);
  const longest = Math.max(bytes.readUInt32BE(16), bytes.readUInt32BE(20));
  const resize = longest > side ? ['--resize', `${Math.round((100 * side) / longest)}%`] : [];
  // Without the attribute, the picture would hold the command with the temporary folder, another one in every build.
  execFileSync('oiiotool', ['--nosoftwareattrib', from, ...resize, '-d', 'uint8', ...options, '--quality', String(QUALITY), '-o', to]);
  return readFileSync(to);
}

/** Size in bytes and 32-bit FNV-1a checksum. */
function checksum(bytes) {
  let value = 0x811c9dc5;
  for (const byte of bytes) value = Math.imul(value ^ byte, 0x01000193);
  return { bytes: bytes.length, fnv1a: value >>> 0 };
}

function pack(source, rig, side, folder) {
  const reader = new Reader(source);
  const writer = new Writer();
  const json = structuredClone(source.json);
  for (const mesh of json.meshes) {
    for (const primitive of mesh.primitives) {
      primitive.attributes = addAttributes(reader, writer, primitive.attributes);
      primitive.indices = copyAccessor(reader, writer, primitive.indices, 34963);
      for (const target of primitive.targets ?? []) {
        for (const name of Object.keys(target)) target[name] = copyAccessor(reader, writer, target[name]);
      }
    }
  }
  for (const skin of json.skins) skin.inverseBindMatrices = copyAccessor(reader, writer, skin.inverseBindMatrices);
  addPictures(json, reader, writer, rig, side, folder);
  // What drawing needs of the rig. The daemon has the rest.
  const { name, regions, wrinkle_maps: maps } = rig;
  const places = (regions ?? []).map(({ name: region, mask, feeds }) => ({ name: region, mask, feeds: (feeds ?? []).map(({ map }) => ({ map })) }));
  json.scenes[json.scene ?? 0].extras = { ...json.scenes[json.scene ?? 0].extras, furrow_source: source.checksums, furrow_rig: { name, regions: places, wrinkle_maps: maps } };
  json.extensionsUsed = [...new Set([...(json.extensionsUsed ?? []), 'KHR_mesh_quantization'])];
  json.extensionsRequired = [...new Set([...(json.extensionsRequired ?? []), 'KHR_mesh_quantization'])];
  json.accessors = writer.accessors;
  json.bufferViews = writer.views;
  json.buffers = [{ byteLength: writer.size }];
  return glb(json, Buffer.concat(writer.parts));
}

function addPictures(json, reader, writer, rig, side, folder) {
  const used = new Map(); // texture of the source -> of the package
  const [textures, images] = [[], []];
  const add = (index, options) => {
    if (!used.has(index)) {
      const image = reader.json.images[reader.json.textures[index].source];
      const bytes = reader.view(image.bufferView);
      const keep = hasAlpha(bytes) || image.mimeType !== 'image/png';
      const out = keep ? bytes : shrink(bytes, side, folder, options);
      used.set(index, images.length);
      textures.push({ source: images.length });
      images.push({ name: image.name, mimeType: keep ? image.mimeType : 'image/jpeg', bufferView: writer.addView(out) });
    }
    return used.get(index);
  };
  const exact = ['--attrib', 'jpeg:subsampling', '4:4:4']; // directions, whose channels matter alike
  for (const material of json.materials) {
    const { pbrMetallicRoughness: pbr = {} } = material;
    if (pbr.baseColorTexture) pbr.baseColorTexture.index = add(pbr.baseColorTexture.index, []);
    if (pbr.metallicRoughnessTexture) pbr.metallicRoughnessTexture.index = add(pbr.metallicRoughnessTexture.index, []);
    if (material.normalTexture) material.normalTexture.index = add(material.normalTexture.index, exact);
    const thickness = material.extensions?.KHR_materials_volume?.thicknessTexture;
    if (thickness) thickness.index = add(thickness.index, []);
  }
  for (const name of rigPictures(rig)) {
    const image = reader.json.images.findIndex((each) => each.name === name);
    const texture = reader.json.textures.findIndex(({ source }) => source === image);
    if (image < 0 || texture < 0) fail(`the rig's picture '${name}' is not inside the package`);
    add(texture, exact);
  }
  json.textures = textures;
  json.images = images;
}

function glb(json, binary) {
  const pad = (bytes, filler) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]);
  const text = pad(Buffer.from(JSON.stringify(json)), ' ');
  const data = pad(binary, 0);
  const head = Buffer.alloc(20);
  head.write('glTF', 0, 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + text.length + data.length, 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16, 'latin1');
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(data.length, 0);
  chunk.write('BIN\0', 4, 'latin1');
  return Buffer.concat([head, text, chunk, data]);
}

const [input, output] = process.argv.slice(2);
if (output === undefined) {
  console.error('usage: pack_character.mjs IN.glb OUT.glb');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'furrow-pack-'));
try {
  const rigFile = readFileSync(input.replace(/\.glb$/, '.rig.json'));
  const source = { ...readGlb(input), checksums: { character: checksum(readFileSync(input)), rig: checksum(rigFile) } };
  const rig = JSON.parse(withoutComments(rigFile.toString('utf8')));
  let bytes;
  let side;
  for (side of SIDES) {
    bytes = pack(source, rig, side, folder);
    if (bytes.length <= LIMIT_BYTES) break;
  }
  if (bytes.length > LIMIT_BYTES) fail(`${input}: ${bytes.length} bytes with pictures of ${side} pixels; browsers get at most ${LIMIT_BYTES}`);
  writeFileSync(output, bytes);
  console.log(`${output}: ${bytes.length} bytes, pictures of at most ${side} pixels`);
} catch (error) {
  console.error(`pack_character: ${error.code === 'ENOENT' && error.path === 'oiiotool' ? 'oiiotool is missing (install openimageio-tools)' : error.message}`);
  process.exitCode = 1;
} finally {
  rmSync(folder, { recursive: true });
}
