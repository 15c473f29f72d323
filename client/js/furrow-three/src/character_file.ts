// SPDX-License-Identifier: Apache-2.0
// Reads a character package: a .glb file, its wrinkle rig, and the pictures that the rig names.
import { LinearMipmapNearestFilter, NoColorSpace, RepeatWrapping, SRGBColorSpace, type Texture, TextureLoader } from 'three';
import { type GLTF, GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { type DrawnRig, readRig } from './rig/rig_file.js';

export interface CharacterFile {
  gltf: GLTF;
  rig: DrawnRig;
  /** A picture of the rig: embedded ones by name, others as files beside the rig. */
  picture(name: string, kind: 'mask' | 'data' | 'colour'): Promise<Texture>;
}

interface GltfJson {
  images?: { name?: string }[];
  textures?: { source?: number; extensions?: Record<string, { source?: number }> }[];
  scene?: number;
  scenes?: { extras?: { furrow_rig?: unknown } }[];
}

async function fetchText(url: string): Promise<string> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: HTTP status ${response.status}`);
  return response.text();
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
export async function readCharacter(url: string, rigUrl?: string): Promise<CharacterFile> {
  const loader = new GLTFLoader();
  loader.setMeshoptDecoder(MeshoptDecoder);
  const gltf = await loader.loadAsync(url);
  const json = gltf.parser.json as GltfJson;
  const embedded = json.scenes?.[json.scene ?? 0]?.extras?.furrow_rig;
  const beside = rigUrl ?? url.replace(/(\.glb)?(\?.*)?$/, '.rig.json');
  const rig = rigUrl === undefined && embedded !== undefined
    ? readRig(typeof embedded === 'string' ? embedded : JSON.stringify(embedded)) : readRig(await fetchText(beside));
  return {
    gltf,
    rig,
    picture: async (name, kind) => {
      const index = textureOf(json, name);
      if (index >= 0) return prepare((await gltf.parser.getDependency('texture', index)) as Texture, kind);
      const texture = await new TextureLoader().loadAsync(new URL(name, new URL(beside, document.baseURI)).href);
      texture.flipY = false;
      return prepare(texture, kind);
    },
  };
}
