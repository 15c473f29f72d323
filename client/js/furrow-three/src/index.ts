// SPDX-License-Identifier: Apache-2.0
export { type CharacterOptions, FurrowCharacter, loadCharacter, type Weights } from './character.js';
export { type Pose, type PoseSkeleton } from './pose/joint_poser.js';
export { addWrinkles, type View, type WrinkleInput, type WrinkleTextures } from './wrinkles/wrinkle_material.js';
export { SlopeMaker } from './wrinkles/slopes.js';
export { type DrawnRig, readRig } from './rig/rig_file.js';
export { type CameraPlace, Follower } from './view/follow.js';
export { Studio, STUDIO_BACKGROUND } from './view/studio.js';
export {
  defaultSettings, type LightSettings, type ReadSettings, readSettings, type ShadowSettings, type SkinViewName, type StudioSettings,
} from './settings.js';
export { StudioView, type StudioViewOptions } from './view/studio_view.js';
