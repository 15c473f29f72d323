// SPDX-License-Identifier: Apache-2.0
// How skin weights change along the surface, which gives a skinned surface its true normals: a cheek that moves forward
// becomes round. render/mesh/weight_gradients.h explains it and is the same in C++ (after Tarini, Panozzo and
// Sorkine-Hornung 2014, "Accurate and Efficient Lighting for Skinned Models").
import { BufferAttribute, type BufferGeometry, Vector3 } from 'three';
import { weightOf, weldVertices } from './weld.js';

function neighboursOf(geometry: BufferGeometry, welded: Uint32Array): number[][] {
  const index = geometry.index;
  const count = index?.count ?? welded.length;
  const neighbours: number[][] = Array.from(welded, () => []);
  for (let i = 0; i + 2 < count; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const corner = (at: number): number => welded[index ? index.getX(at) : at]!;
      const [a, b] = [corner(i + k), corner(i + ((k + 1) % 3))];
      if (a === b) continue;
      neighbours[a]!.push(b);
      neighbours[b]!.push(a);
    }
  }
  return neighbours;
}

function fromAttribute(attribute: { getX(i: number): number; getY(i: number): number; getZ(i: number): number }, i: number): Vector3 {
  return new Vector3(attribute.getX(i), attribute.getY(i), attribute.getZ(i));
}

/**
 * Adds the attributes `furrowAlong` and `furrowAcross` (vec4, per metre: one component per influence of the vertex).
 * Needs normals, tangents and influences.
 */
export function addWeightGradients(geometry: BufferGeometry): void {
  const { position, normal, tangent, skinIndex, skinWeight } = geometry.attributes;
  const count = position!.count;
  const welded = weldVertices(geometry);
  const neighbours = neighboursOf(geometry, welded);
  const along = new Float32Array(4 * count);
  const across = new Float32Array(4 * count);
  for (let v = 0; v < count; ++v) {
    const place = fromAttribute(position!, v);
    const up = fromAttribute(normal!, v);
    const y = up.clone().cross(fromAttribute(tangent!, v)).normalize();
    const x = y.clone().cross(up).normalize();
    let [xx, xy, yy] = [0, 0, 0];
    const [sumX, sumY] = [[0, 0, 0, 0], [0, 0, 0, 0]];
    for (const other of neighbours[welded[v]!]!) {
      const step = fromAttribute(position!, other).sub(place);
      const [flatX, flatY] = [step.dot(x), step.dot(y)];
      const [length, flat] = [step.length(), Math.hypot(flatX, flatY)];
      if (!(flat > 1e-3 * length)) continue;
      const [cx, cy] = [flatX / flat, flatY / flat];
      xx += cx * cx;
      xy += cx * cy;
      yy += cy * cy;
      for (let k = 0; k < 4; ++k) {
        if (skinWeight!.getComponent(v, k) <= 0) continue;
        const joint = skinIndex!.getComponent(v, k);
        const change = (weightOf(geometry, other, joint) - weightOf(geometry, v, joint)) / length;
        sumX[k]! += cx * change;
        sumY[k]! += cy * change;
      }
    }
    const determinant = xx * yy - xy * xy;
    // Neighbours in one line do not tell the change across it.
    if (!(determinant > 1e-3 * (xx + yy) * (xx + yy))) continue;
    for (let k = 0; k < 4; ++k) {
      along[4 * v + k] = (sumX[k]! * yy - sumY[k]! * xy) / determinant;
      across[4 * v + k] = (sumY[k]! * xx - sumX[k]! * xy) / determinant;
    }
  }
  geometry.setAttribute('furrowAlong', new BufferAttribute(along, 4));
  geometry.setAttribute('furrowAcross', new BufferAttribute(across, 4));
}
