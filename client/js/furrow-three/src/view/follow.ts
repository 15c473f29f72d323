// SPDX-License-Identifier: Apache-2.0
// A camera that goes with a joint, as the daemon's camera presets do (render/scene/camera_frame.cpp).
import { Matrix4, type Object3D, type PerspectiveCamera, Quaternion, Vector3 } from 'three';
import type { FurrowCharacter } from '../character.js';

/** In metres in the character's model space, degrees. GET /api/cameras of a daemon lists presets. */
export interface CameraPlace {
  eye: readonly [number, number, number];
  target: readonly [number, number, number];
  fovDegrees: number;
  /** Goes with the followed joint, and the angle spans the shorter side of the picture. */
  follows: boolean;
}

interface Rest {
  joint: Vector3;
  bodyInverse: Matrix4;
}

const UP = new Vector3(0, 1, 0);

/** Takes the movement of a joint, but only the turn of the body about +Y: nods stay visible. */
export class Follower {
  private readonly joint: Object3D | null;
  private readonly body: Object3D | null;
  private readonly rest: Rest;

  /** The character must be at rest. `joint`: default: the head. `body`: default: the joint's first ancestor. */
  constructor(private readonly character: FurrowCharacter, joint = 'head', body?: string) {
    this.joint = character.joint(joint);
    this.body = body === undefined ? this.firstAncestor() : character.joint(body);
    character.updateWorldMatrix(true, true);
    this.rest = {
      joint: this.placeOf(this.joint),
      bodyInverse: this.modelOf(this.body).invert(),
    };
  }

  private firstAncestor(): Object3D | null {
    let body = this.joint;
    const names = new Set(this.character.jointNames);
    while (body?.parent && names.has(body.parent.name)) body = body.parent;
    return body;
  }

  private modelOf(node: Object3D | null): Matrix4 {
    if (node === null) return new Matrix4();
    return this.character.matrixWorld.clone().invert().multiply(node.matrixWorld);
  }

  private placeOf(node: Object3D | null): Vector3 {
    return new Vector3().setFromMatrixPosition(this.modelOf(node));
  }

  /** From the model space of the rest pose to where the joint has taken it. */
  transform(): Matrix4 {
    if (this.joint === null) return new Matrix4();
    this.character.updateWorldMatrix(true, true);
    const turned = new Quaternion();
    this.modelOf(this.body).multiply(this.rest.bodyInverse).decompose(new Vector3(), turned, new Vector3());
    const heading = new Quaternion().setFromAxisAngle(UP, 2 * Math.atan2(turned.y, turned.w));
    const to = this.placeOf(this.joint);
    const { x, y, z } = this.rest.joint;
    return new Matrix4().makeTranslation(to.x, to.y, to.z)
      .multiply(new Matrix4().makeRotationFromQuaternion(heading))
      .multiply(new Matrix4().makeTranslation(-x, -y, -z));
  }

  /** Places a camera of three.js; `aspect`: width / height. Returns what it looks at. */
  place(camera: PerspectiveCamera, place: CameraPlace, aspect: number): Vector3 {
    const follow = place.follows ? this.transform() : new Matrix4();
    const eye = new Vector3(...place.eye).applyMatrix4(follow);
    const target = new Vector3(...place.target).applyMatrix4(follow);
    const distance = eye.distanceTo(target);
    const half = Math.tan((place.fovDegrees * Math.PI) / 360) / (place.follows ? Math.min(aspect, 1) : 1);
    camera.fov = (2 * Math.atan(half) * 180) / Math.PI;
    camera.aspect = aspect;
    camera.near = 0.05 * distance;
    camera.far = 20 * distance;
    camera.position.copy(eye);
    camera.lookAt(target);
    camera.updateProjectionMatrix();
    return target;
  }
}
