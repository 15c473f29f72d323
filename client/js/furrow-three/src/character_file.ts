// SPDX-License-Identifier: Apache-2.0
// Reads a character package: a .glb file, its wrinkle rig, and the pictures that the rig names.
import {
  LinearFilter, LinearMipmapLinearFilter, LinearMipmapNearestFilter, NoColorSpace, RepeatWrapping, SRGBColorSpace, Texture,
  TextureLoader,
} from 'three';
import { type GLTF, GLTFLoader, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { type MaterialBind, readMaterialBinds } from './mesh/material_binds.js';
import { type DrawnRig, readRig } from './rig/rig_file.js';

export interface CharacterFile {
  gltf: GLTF;
  rig: DrawnRig;
  binds: MaterialBind[];
  /** A picture of the rig: embedded ones by name, others as files beside the rig. */
  picture(name: string, kind: 'mask' | 'data' | 'colour'): Promise<Texture>;
}

interface GltfJson {
  extensionsUsed?: string[];
  images?: { name?: string; bufferView?: number; mimeType?: string }[];
  textures?: { source?: number; extensions?: Record<string, { source?: number }> }[];
  scene?: number;
  scenes?: { extras?: { furrow_rig?: unknown; furrow_material_binds?: unknown } }[];
}

async function fetchText(url: string, headers: Record<string, string>): Promise<string> {
  const response = await fetch(url, { headers });
  if (!response.ok) throw new Error(`${url}: HTTP status ${response.status}`);
  return response.text();
}

async function fetchBytes(url: string, headers: Record<string, string>): Promise<ArrayBuffer> {
  const response = await fetch(url, { headers });
  if (!response.ok) throw new Error(`${url}: HTTP status ${response.status}`);
  return response.arrayBuffer();
}

/** True if a .glb file states that it uses an extension. */
function uses(bytes: ArrayBuffer, extension: string): boolean {
  const view = new DataView(bytes);
  if (bytes.byteLength < 20) return false;
  const size = Math.min(view.getUint32(12, true), bytes.byteLength - 20);
  return new TextDecoder().decode(new Uint8Array(bytes, 20, size)).includes(`"${extension}"`);
}

/** Decodes embedded pictures from memory. Three would fetch them from blob: addresses, which pages may forbid. */
class EmbeddedPictures implements GLTFLoaderPlugin {
  readonly name = 'FURROW_embedded_pictures';

  constructor(private readonly parser: GLTFParser) {}

  loadTexture(index: number): Promise<Texture> | null {
    const json = this.parser.json as GltfJson;
    const texture = json.textures?.[index];
    const source = Object.values(texture?.extensions ?? {}).find((extension) => extension.source !== undefined)?.source ?? texture?.source;
    const image = source === undefined ? undefined : json.images?.[source];
    return image?.bufferView === undefined ? null : this.decode(image.bufferView, image.mimeType ?? 'image/png');
  }

  private async decode(bufferView: number, type: string): Promise<Texture> {
    const bytes = (await this.parser.getDependency('bufferView', bufferView)) as ArrayBuffer;
    const bitmap = await createImageBitmap(new Blob([bytes], { type }), { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
    const texture = new Texture(bitmap);
    texture.flipY = false;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.minFilter = LinearMipmapLinearFilter;
    texture.magFilter = LinearFilter;
    texture.needsUpdate = true;
    return texture;
  }
}

/** The index of the texture that shows an image; -1: none. */
function textureOf(json: GltfJson, name: string): number {
  const image = (json.images ?? []).findIndex((each) => each.name === name);
  if (image < 0) return -1;
  return (json.textures ?? []).findIndex(({ source, extensions }) => source === image ||
    Object.values(extensions ?? {}).some((extension) => extension.source === image));
}

function prepare(texture: Texture, kind: 'mask' | 'data' | 'colour'): Texture {
  // The texture may belong to a material, too, with other settings.
  const own = texture.clone();
  own.colorSpace = kind === 'colour' ? SRGBColorSpace : NoColorSpace;
  own.wrapS = own.wrapT = RepeatWrapping;
  if (kind === 'mask') own.minFilter = LinearMipmapNearestFilter;
  own.needsUpdate = true;
  return own;
}

/**
 * `url`: of the .glb file. `rigUrl`: of the rig; by default the rig inside the .glb file (scene extra `furrow_rig`),
 * else "<stem>.rig.json" beside the file.
 */
export async function readCharacter(url: string, rigUrl?: string, headers: Record<string, string> = {}): Promise<CharacterFile> {
  const loader = new GLTFLoader();
  loader.register((parser) => new EmbeddedPictures(parser));
  const bytes = await fetchBytes(url, headers);
  if (uses(bytes, 'EXT_meshopt_compression')) {
    // Loaded only if it is needed: it is WebAssembly, which pages may forbid.
    loader.setMeshoptDecoder((await import('three/addons/libs/meshopt_decoder.module.js')).MeshoptDecoder);
  }
  const gltf = await loader.parseAsync(bytes, url.replace(/[^/]*$/, ''));
  const json = gltf.parser.json as GltfJson;
  const extras = json.scenes?.[json.scene ?? 0]?.extras;
  const embedded = extras?.furrow_rig;
  const beside = rigUrl ?? url.replace(/(\.glb)?(\?.*)?$/, '.rig.json');
  const rig = rigUrl === undefined && embedded !== undefined
    ? readRig(typeof embedded === 'string' ? embedded : JSON.stringify(embedded)) : readRig(await fetchText(beside, headers));
  return {
    gltf,
    rig,
    binds: readMaterialBinds(extras?.furrow_material_binds),
    picture: async (name, kind) => {
      const index = textureOf(json, name);
      if (index >= 0) return prepare((await gltf.parser.getDependency('texture', index)) as Texture, kind);
      const texture = await new TextureLoader().loadAsync(new URL(name, new URL(beside, document.baseURI)).href);
      texture.flipY = false;
      return prepare(texture, kind);
    },
  };
}
