// SPDX-License-Identifier: Apache-2.0
// A character of Furrow in a scene of three.js.
import {
  Color, CustomBlending, DoubleSide, FrontSide, Group, type IUniform, type Material, type MeshStandardMaterial, MeshPhysicalMaterial,
  NoBlending, NormalBlending, type Object3D, OneFactor, SkinnedMesh, SrcAlphaFactor, SrcColorFactor, type Texture,
  type WebGLRenderer, type WebGLRenderTarget, ZeroFactor,
} from 'three';
import { type CharacterFile, readCharacter } from './character_file.js';
import { BoundMaterial } from './mesh/material_binds.js';
import { addWeightGradients } from './mesh/weight_gradients.js';
import { type Joint, JointPoser, type Pose, type PoseSkeleton } from './pose/joint_poser.js';
import { type Kind, KINDS } from './skin/materials.js';
import { SkinParts } from './skin/skin_parts.js';
import { whyNoSkin } from './skin/support.js';
import { type Relief, SlopeMaker } from './wrinkles/slopes.js';
import { Studio } from './view/studio.js';
import { addWrinkles, type View, type WrinkleInput, type WrinkleTextures } from './wrinkles/wrinkle_material.js';
import { WrinkleSet } from './wrinkles/wrinkle_set.js';

/** Weights by name, as `WeightFrame` of the package `furrow` has them. */
export interface Weights {
  names: readonly string[];
  values: ArrayLike<number>;
}

export interface CharacterOptions {
  /** Of the wrinkle rig (default: inside the .glb file, or "<stem>.rig.json" beside it). */
  rigUrl?: string;
  /** Of the requests for the .glb file and its rig, for example one that shows a token. */
  headers?: Record<string, string>;
  /**
   * The picture has several samples per pixel, so hair and lashes have soft edges (default: whether the renderer was made
   * with `antialias`). Set it to true if you draw into a multisampled target, and to false if you draw into another.
   */
  softEdges?: boolean;
  /**
   * Prepares skin shading, which StudioView draws (default: true). It takes twice the memory for normal maps. False, or a
   * GPU that cannot draw it: `character.skin` is null, and `character.whyNoSkin` says why.
   */
  skin?: boolean;
}

/** Reflectance at normal incidence by kind of surface (render/scene/gpu_character.cpp). Three's materials have 0.04. */
const REFLECTANCE: Record<Kind, number> = { skin: 0.028, eye: 0.04, hair: 0.03, cloth: 0.012, other: 0.03, shade: 0 };
/** An eye's surface is the smooth tear film, whatever its texture says. */
const ROUGHEST_EYE = 0.3;
/** Base colour below which skin counts as a painted hollow, which has no gloss. */
const CAVITY_ALBEDO = 0.02;
/** Textures that three and its shadow maps use themselves. */
const OTHER_TEXTURES = 6;
/** The slopes of all maps are layers of one texture. */
const SLOPES = 1;

interface Part {
  mesh: SkinnedMesh;
  material: MeshPhysicalMaterial;
  input: WrinkleInput;
  kind: Kind;
}

/** Make one with loadCharacter(). Add it to a scene, and call setPose() and setWeights() when new ones arrive. */
export class FurrowCharacter extends Group {
  private view: View = 'final';

  /** Programs call loadCharacter() instead. */
  constructor(
    private readonly parts: readonly Part[],
    private readonly sets: readonly WrinkleSet[],
    private readonly joints: readonly Joint[],
    private readonly poser: JointPoser,
    private readonly targets: readonly WebGLRenderTarget[],
    private readonly textures: readonly Texture[],
    private readonly bound: readonly BoundMaterial[],
    private readonly softEdges: boolean,
    /** The lamps of the view 'studio'. Call update() before each picture. */
    readonly studio: Studio,
    /** Regions that are not drawn, because their masks follow joints. */
    readonly notDrawn: readonly string[],
    /** For StudioView; null: the character cannot be drawn with skin shading. */
    readonly skin: SkinParts | null,
    /** Why there is no skin shading; empty: there is. */
    readonly whyNoSkin: string,
    /** Some material sends out light, or may. */
    readonly emits: boolean,
  ) {
    super();
  }

  /** The wrinkle weights that are drawn. */
  get weightNames(): string[] {
    return [...new Set(this.sets.flatMap((set) => set.weightNames))];
  }

  /** True if a skeleton has this character's joints at these places, so that setPose() needs no retargeting. */
  fits(skeleton: PoseSkeleton): boolean {
    return this.poser.fits(skeleton);
  }

  /** Names of the joints. */
  get jointNames(): string[] {
    return this.joints.map(({ name }) => name);
  }

  /** The node of a joint, to attach things to or to pose it yourself; null if there is none of this name. */
  joint(name: string): Object3D | null {
    return this.joints.find((joint) => joint.name === name)?.node ?? null;
  }

  /** Moves joints and morph targets of equal names. Joints that the pose's skeleton lacks rest. */
  setPose(pose: Pose): void {
    this.poser.apply(pose);
    for (const { mesh } of this.parts) {
      const { morphTargetDictionary: targets, morphTargetInfluences: influences } = mesh;
      if (!targets || !influences) continue;
      influences.fill(0);
      pose.skeleton.blendShapeNames.forEach((name, i) => {
        const target = targets[name];
        if (target !== undefined) influences[target] = pose.blendShapes[i]!;
      });
    }
    const { blendShapeNames: names } = pose.skeleton;
    for (const material of this.bound) material.apply((shape) => pose.blendShapes[names.indexOf(shape)] ?? 0);
  }

  /** Back to the rest pose, without wrinkles. */
  reset(): void {
    this.poser.toRest();
    for (const { mesh } of this.parts) mesh.morphTargetInfluences?.fill(0);
    for (const material of this.bound) material.apply(() => 0);
    this.setWeights({ names: [], values: [] });
  }

  /** Sets all wrinkle weights; those without a name are 0. */
  setWeights({ names, values }: Weights): void {
    for (const set of this.sets) set.setWeights(names, values);
  }

  /**
   * 'final': lit by the scene. 'studio': as the daemon's default picture. 'normal': the normals as seen, as
   * `furrow render --view normal` shows them. 'facets': for StudioView.
   */
  setView(view: View): void {
    if (view === this.view) return;
    this.view = view;
    for (const { mesh, material, input, kind } of this.parts) {
      material.toneMapped = view === 'final';
      if (kind === 'shade') {
        mesh.visible = view !== 'normal' && (view !== 'facets' || this.skin?.hasShades === true);
        // The alpha of facets is a factor, too. That of a picture stays.
        material.blendSrcAlpha = ZeroFactor;
        material.blendDstAlpha = view === 'facets' ? SrcAlphaFactor : OneFactor;
      } else {
        setCutOut(material, view !== 'facets' && this.softEdges, view === 'facets');
      }
      addWrinkles(material, input, view);
    }
  }

  /** Frees all memory of the GPU. */
  dispose(): void {
    for (const { mesh, material } of this.parts) {
      mesh.geometry.dispose();
      mesh.skeleton.dispose();
      material.dispose();
    }
    for (const target of this.targets) target.dispose();
    for (const texture of this.textures) texture.dispose();
    this.skin?.dispose();
  }
}

function kindOf(material: Material): Kind {
  const kind = (material.userData as { furrow_kind?: unknown }).furrow_kind;
  return KINDS.find((each) => each === kind) ?? 'other';
}

/** Edges of cut-outs, such as hair: soft by coverage, or single samples. `isData`: the targets hold data. */
function setCutOut(material: MeshPhysicalMaterial, soft: boolean, isData: boolean): void {
  material.alphaToCoverage = material.alphaTest > 0 && soft;
  if (material.alphaToCoverage) keepOpaque(material);
  else material.blending = isData ? NoBlending : NormalBlending;
}

function sendsLight(material: MeshStandardMaterial): boolean {
  return material.emissiveMap !== null || (material.emissive.getHex() !== 0 && material.emissiveIntensity > 0);
}

/** Multiplies the picture behind by the material's colour. */
function darken(material: MeshPhysicalMaterial): void {
  material.transparent = true; // after everything else
  material.forceSinglePass = true;
  material.depthWrite = false;
  material.blending = CustomBlending;
  material.blendSrc = ZeroFactor;
  material.blendDst = SrcColorFactor;
  material.blendSrcAlpha = ZeroFactor;
  material.blendDstAlpha = OneFactor;
}

/** The alpha of a fragment says how many samples it covers. The picture itself must stay opaque. */
function keepOpaque(material: Material): void {
  material.blending = CustomBlending;
  material.blendSrc = OneFactor;
  material.blendDst = ZeroFactor;
  material.blendSrcAlpha = OneFactor;
  material.blendDstAlpha = OneFactor;
}

/** What the materials of a surface share. */
type MapInput = Pick<WrinkleInput, 'masks' | 'slopes' | 'maps'>;

class Builder {
  private readonly parts: Part[] = [];
  private readonly targets: WebGLRenderTarget[] = [];
  private readonly textures = new Set<Texture>();
  private readonly bound: BoundMaterial[] = [];
  private readonly slopes: SlopeMaker;
  private readonly basesOf = new Map<Texture, Texture>();
  private readonly sets: Record<'skin' | 'cloth', WrinkleSet>;
  private readonly inputs = new Map<WrinkleSet, Promise<MapInput>>();
  private readonly materials = new Map<string, { material: MeshPhysicalMaterial; input: WrinkleInput }>();
  private readonly studio = new Studio();
  private readonly skin: SkinParts | null;
  private hasSkin = false;
  private emits = false;

  constructor(private readonly file: CharacterFile, private readonly renderer: WebGLRenderer, private readonly softEdges: boolean,
    private readonly whyNot: string) {
    this.skin = whyNot === '' ? new SkinParts(renderer) : null;
    this.slopes = new SlopeMaker(renderer, this.skin !== null);
    this.sets = { skin: new WrinkleSet(file.rig, 'skin'), cloth: new WrinkleSet(file.rig, 'cloth') };
  }

  async build(): Promise<FurrowCharacter> {
    try {
      return await this.assemble();
    } catch (error) {
      for (const made of [...this.targets, ...this.textures]) made.dispose();
      this.skin?.dispose();
      throw error;
    } finally {
      this.slopes.dispose();
    }
  }

  private async assemble(): Promise<FurrowCharacter> {
    const { scene } = this.file.gltf;
    const meshes: SkinnedMesh[] = [];
    scene.traverse((object) => {
      if (object instanceof SkinnedMesh) meshes.push(object);
    });
    if (meshes.length === 0) throw new Error('furrow-three: the file has no skinned mesh');
    this.hasSkin = meshes.some(({ material }) => kindOf(material as Material) === 'skin');
    // Shapes may raise light that is 0 at rest.
    this.emits = this.file.binds.length > 0 || meshes.some(({ material }) => sendsLight(material as MeshStandardMaterial));
    for (const mesh of meshes) await this.addMesh(mesh);
    const joints = this.jointsOf(meshes[0]!);
    const character = new FurrowCharacter(this.parts, Object.values(this.sets), joints, new JointPoser(joints), this.targets,
      [...this.textures], this.bound, this.softEdges, this.studio, this.file.rig.notDrawn, this.skin, this.whyNot, this.emits);
    character.add(scene);
    return character;
  }

  /** The joints with the names that the file states, which three changes. */
  private jointsOf(mesh: SkinnedMesh): Joint[] {
    const { associations, json } = this.file.gltf.parser;
    const names = (json as { nodes: { name?: string }[] }).nodes;
    const { bones } = mesh.skeleton;
    return bones.map((node) => {
      const index = associations.get(node)?.nodes;
      return { name: (index === undefined ? undefined : names[index]?.name) ?? node.name, node, parent: bones.indexOf(node.parent as never) };
    });
  }

  private setOf(kind: Kind, source: Material): WrinkleSet | null {
    if ((source.userData as { furrow_wrinkles?: unknown }).furrow_wrinkles === false) return null;
    if (kind === 'skin' || kind === 'cloth') return this.sets[kind];
    return kind === 'other' && !this.hasSkin ? this.sets.skin : null;
  }

  private async addMesh(mesh: SkinnedMesh): Promise<void> {
    const source = mesh.material as MeshStandardMaterial;
    const { geometry } = mesh;
    if (!geometry.attributes.tangent && geometry.attributes.uv && geometry.index) geometry.computeTangents();
    const kind = kindOf(source);
    // Cloth does not follow its joints' weights as closely: its folds are maps.
    const gradients = kind === 'skin' && geometry.attributes.tangent !== undefined;
    if (gradients) addWeightGradients(geometry);
    const made = await this.materialOf(source, kind, gradients);
    mesh.material = made.material;
    mesh.frustumCulled = false; // three would use the bounds of the rest pose
    this.parts.push({ mesh, ...made, kind });
    this.skin?.add(mesh, made.material, kind);
  }

  private async materialOf(source: MeshStandardMaterial, kind: Kind, gradients: boolean): Promise<Pick<Part, 'material' | 'input'>> {
    const key = source.uuid;
    const known = this.materials.get(key);
    if (known) return known;
    const material = new MeshPhysicalMaterial({
      name: source.name,
      color: source.color,
      map: source.map,
      normalMap: source.normalMap, // for its UVs
      roughness: kind === 'eye' ? Math.min(source.roughness, ROUGHEST_EYE) : source.roughness,
      roughnessMap: source.roughnessMap,
      opacity: source.opacity, // alphaTest compares it, times the map's alpha
      emissive: source.emissive,
      emissiveMap: source.emissiveMap,
      emissiveIntensity: source.emissiveIntensity,
      metalness: 0,
      specularIntensity: REFLECTANCE[kind] / 0.04,
      specularColor: new Color(1, 1, 1),
      alphaTest: source.alphaTest,
      side: source.side === DoubleSide ? DoubleSide : FrontSide,
    });
    if (kind === 'shade') darken(material);
    else setCutOut(material, this.softEdges, false);
    const set = this.setOf(kind, source);
    const input: WrinkleInput = {
      base: source.normalMap ? this.baseOf(source.normalMap) : null,
      ...(set ? await this.inputOf(set, material) : { masks: [], slopes: null, maps: [] }),
      weights: set?.weights ?? [],
      gradients,
      oneNormal: kind === 'hair',
      studio: {
        ...this.studio.uniforms,
        furrowSpecular: { value: REFLECTANCE[kind] },
        furrowCavityAlbedo: { value: kind === 'skin' ? CAVITY_ALBEDO : 0 },
      },
      ...(this.skin ? { facets: { kind, uniforms: this.facetUniforms(this.skin, source, kind) } } : {}),
    };
    this.bind(source, material);
    for (const texture of [material.map, material.normalMap, material.roughnessMap, material.emissiveMap]) if (texture) this.textures.add(texture);
    addWrinkles(material, input, 'final');
    this.materials.set(key, { material, input });
    return { material, input };
  }

  private facetUniforms(skin: SkinParts, source: MeshStandardMaterial, kind: Kind): Record<string, IUniform> {
    const { thickness = 0, thicknessMap = null } = source as Partial<MeshPhysicalMaterial>;
    if (thicknessMap) this.textures.add(thicknessMap);
    return {
      ...skin.uniforms,
      furrowCavityAlbedo: { value: kind === 'skin' ? CAVITY_ALBEDO : 0 },
      furrowThickness: { value: thickness },
      // The same UVs as the base colour, as glTF of Furrow has them.
      ...(thicknessMap && source.map ? { furrowThicknessMap: { value: thicknessMap } } : {}),
    };
  }

  /** Lets shapes change the material, if the file says so. Its textures become its own, because their UVs may move. */
  private bind(source: MeshStandardMaterial, material: MeshPhysicalMaterial): void {
    const index = this.file.gltf.parser.associations.get(source)?.materials;
    const binds = this.file.binds.filter((bind) => bind.material === index);
    if (binds.length === 0) return;
    for (const name of ['map', 'normalMap', 'roughnessMap', 'emissiveMap'] as const) material[name] = material[name]?.clone() ?? null;
    // Changes are in the units of the emission, which three keeps apart.
    material.emissive.multiplyScalar(material.emissiveIntensity);
    material.emissiveIntensity = 1;
    this.bound.push(new BoundMaterial(material, binds));
  }

  private baseOf(picture: Texture): Texture {
    const known = this.basesOf.get(picture);
    if (known) return known;
    const target = this.slopes.make({ picture, scale: 0 });
    this.targets.push(target);
    this.basesOf.set(picture, target.texture);
    return target.texture;
  }

  private inputOf(set: WrinkleSet, material: MeshPhysicalMaterial): Promise<MapInput> {
    const known = this.inputs.get(set);
    if (known) return known;
    const made = this.loadSet(set, material);
    this.inputs.set(set, made);
    return made;
  }

  private async loadSet(set: WrinkleSet, material: MeshPhysicalMaterial): Promise<MapInput> {
    const load = async (name: string, kind: 'mask' | 'data' | 'colour'): Promise<Texture> => {
      const texture = await this.file.picture(name, kind);
      this.textures.add(texture);
      return texture;
    };
    const masks = await Promise.all(set.masks.map((name) => load(name, 'mask')));
    const own = [material.map, material.normalMap, material.roughnessMap, material.emissiveMap].filter(Boolean).length;
    const reliefs: Relief[] = [];
    let free = this.renderer.capabilities.maxTextures - OTHER_TEXTURES - own - masks.length - SLOPES;
    const maps: WrinkleTextures[] = [];
    for (const map of set.maps) {
      const relief = map.derivative || map.normal;
      // Colours and cavities are drawn as far as the GPU's texture units reach.
      const take = (name: string): boolean => name !== '' && free-- > 0;
      if (relief !== '') reliefs.push({ picture: await this.file.picture(relief, 'data'), scale: map.derivative ? map.derivativeScale : 0 });
      maps.push({
        slope: relief === '' ? null : reliefs.length - 1,
        amplitude: map.amplitude,
        colour: take(map.colour) ? await load(map.colour, 'colour') : null,
        colourScale: map.colourScale,
        cavity: take(map.cavity) ? await load(map.cavity, 'data') : null,
      });
    }
    if (reliefs.length === 0) return { masks, slopes: null, maps };
    const target = this.slopes.makeLayers(reliefs);
    this.targets.push(target);
    return { masks, slopes: target.texture, maps };
  }
}

/**
 * Loads a character package. `url`: of the .glb file. `renderer`: the one that will draw it, because normal maps are
 * converted on its GPU.
 */
export async function loadCharacter(url: string, renderer: WebGLRenderer, options: CharacterOptions = {}): Promise<FurrowCharacter> {
  const softEdges = options.softEdges ?? renderer.getContextAttributes().antialias ?? false;
  const whyNot = options.skin === false ? 'the character was loaded without skin shading' : whyNoSkin(renderer);
  return new Builder(await readCharacter(url, options.rigUrl, options.headers), renderer, softEdges, whyNot).build();
}
