// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// A joint by its position in model space.
struct ModelJoint {
  std::string name;
  std::string parent;  // empty: a root
  glm::vec3 origin{0.0f};
  std::optional<glm::vec3> tail;
};

// `frame_seed` 0: all rest rotations are the identity (BVH); otherwise every joint has
// a random local frame of its own; shape and stance stay the same.
Skeleton MakeSkeleton(const std::vector<ModelJoint>& joints, unsigned frame_seed = 0);

// Hips, spine, neck, head with brows and cheeks, a left arm
// and both legs: 1.7 units tall, facing +Z.
Skeleton MakeBody(unsigned frame_seed = 0, float scale = 1.0f);

// A strain driver over MakeBody(), direction up: 9 vertices on the left cheek, two centimetres
// high; their lowest row is the cheek joint's alone, the highest the head's.
Driver CheekPatch();

// A rig over MakeBody() with drivers of every kind: see the source.
Rig MakeRig();

LocalPose RestPose(const Skeleton& skeleton);

// Turns `joint` away from rest by `rotation`, given in model axes at rest (as JointDelta).
void Turn(const Skeleton& skeleton, const std::string& joint, const glm::quat& rotation,
          LocalPose* pose);
void Move(const Skeleton& skeleton, const std::string& joint, const glm::vec3& translation,
          LocalPose* pose);

glm::quat AngleAxis(float degrees, const glm::vec3& axis);
glm::quat RandomRotation(std::mt19937* random);
glm::vec3 RandomVector(std::mt19937* random, float length);
void RandomPose(const Skeleton& skeleton, std::mt19937* random, LocalPose* pose);

}  // namespace furrow::wrinkle
