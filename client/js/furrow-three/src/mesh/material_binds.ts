// SPDX-License-Identifier: Apache-2.0
// Shapes that change materials: a blush, a face that darkens, irises that slide (scene extra `furrow_material_binds`).
import type { Color, MeshPhysicalMaterial, Texture, Vector2 } from 'three';

/** What a shape adds to a material at a weight of 1 (gltf/scene/material_binds.h). */
export interface MaterialBind {
  shape: string;
  material: number;
  baseColor: readonly number[];
  emission: readonly number[];
  uvScale: readonly number[];
  uvOffset: readonly number[];
}

function numbers(value: unknown, count: number): number[] {
  const list = Array.isArray(value) ? value : [];
  return Array.from({ length: count }, (_, i) => (Number.isFinite(list[i]) ? (list[i] as number) : 0));
}

/** Reads the scene extra. Entries of another form are left out. */
export function readMaterialBinds(extra: unknown): MaterialBind[] {
  const binds: MaterialBind[] = [];
  for (const entry of Array.isArray(extra) ? (extra as Record<string, unknown>[]) : []) {
    if (typeof entry !== 'object' || entry === null || typeof entry.shape !== 'string' || !Number.isInteger(entry.material)) continue;
    binds.push({
      shape: entry.shape, material: entry.material as number, baseColor: numbers(entry.baseColor, 4), emission: numbers(entry.emission, 3),
      uvScale: numbers(entry.uvScale, 2), uvOffset: numbers(entry.uvOffset, 2),
    });
  }
  return binds;
}

const clamp = (value: number): number => Math.min(Math.max(value, 0), 1);

/** The textures of a material that share its UVs. */
function texturesOf(material: MeshPhysicalMaterial): Texture[] {
  return [material.map, material.normalMap, material.roughnessMap, material.emissiveMap].filter((texture) => texture !== null);
}

/** One material, and the binds that change it. */
export class BoundMaterial {
  private readonly color: Color;
  private readonly opacity: number;
  private readonly emission: Color;
  private readonly uvs: readonly { texture: Texture; scale: Vector2; offset: Vector2 }[];

  /** The textures must be the material's own. */
  constructor(private readonly material: MeshPhysicalMaterial, private readonly binds: readonly MaterialBind[]) {
    this.color = material.color.clone();
    this.opacity = material.opacity;
    this.emission = material.emissive.clone();
    this.uvs = texturesOf(material).map((texture) => ({ texture, scale: texture.repeat.clone(), offset: texture.offset.clone() }));
  }

  /** `weightOf`: of a shape. value = value at rest + sum of weight * change. */
  apply(weightOf: (shape: string) => number): void {
    const color = [this.color.r, this.color.g, this.color.b, this.opacity];
    const emission = [this.emission.r, this.emission.g, this.emission.b];
    const scale = [1, 1];
    const offset = [0, 0];
    for (const bind of this.binds) {
      const weight = clamp(weightOf(bind.shape) || 0);
      const add = (to: number[], changes: readonly number[]): void => changes.forEach((change, i) => (to[i]! += weight * change));
      add(color, bind.baseColor);
      add(emission, bind.emission);
      add(scale, bind.uvScale);
      add(offset, bind.uvOffset);
    }
    const [r, g, b, a] = color.map(clamp) as [number, number, number, number];
    this.material.color.setRGB(r, g, b);
    this.material.opacity = a;
    const [er, eg, eb] = emission.map((light) => Math.max(light, 0)) as [number, number, number];
    this.material.emissive.setRGB(er, eg, eb);
    for (const at of this.uvs) {
      at.texture.repeat.set(at.scale.x * scale[0]!, at.scale.y * scale[1]!);
      at.texture.offset.set(at.offset.x * scale[0]! + offset[0]!, at.offset.y * scale[1]! + offset[1]!);
    }
  }
}
