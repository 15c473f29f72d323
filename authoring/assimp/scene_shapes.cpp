// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/scene_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <unordered_set>

#include "authoring/assimp/scene_file.h"
#include "authoring/assimp/shape_groups.h"
#include "motion/clip/limits.h"

namespace furrow::authoring {
namespace {

// The first mesh with blend shapes below the node `name`, or null. FBX's channels are called
// "<node>*<number of the mesh in its node>".
const aiMesh* FindShapeMesh(const aiScene& scene, std::string_view channel) {
  const std::string name(channel.substr(0, channel.rfind('*')));
  const aiNode* node = scene.mRootNode->FindNode(name.c_str());
  for (unsigned m = 0; node != nullptr && m < node->mNumMeshes; ++m) {
    const unsigned mesh = node->mMeshes[m];
    if (mesh < scene.mNumMeshes && scene.mMeshes[mesh]->mNumAnimMeshes > 0)
      return scene.mMeshes[mesh];
  }
  return nullptr;
}

// The time that is 0. assimp 5.2 takes 1e10 off the times of FBX takes that state no span and move
// no node, and gives them a negative duration.
double OriginOf(const aiAnimation& animation) {
  if (animation.mDuration >= 0.0) return 0.0;
  double first = std::numeric_limits<double>::max();
  for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
    const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
    if (channel.mNumKeys > 0) first = std::min(first, channel.mKeys[0].mTime);
  }
  return first;
}

// A key lists the shapes that have a key at its time, so a shape's curve comes from many keys.
// Shapes count with their in-betweens, which FBX moves by one channel.
Result<std::map<unsigned, ShapeCurve>> CurvesOf(const aiMeshMorphAnim& channel, const aiMesh& mesh,
                                                double origin) {
  std::map<unsigned, ShapeCurve> curves;
  const std::vector<ShapeGroup> groups = GroupShapes(mesh);
  for (unsigned k = 0; k < channel.mNumKeys; ++k) {
    const aiMeshMorphKey& key = channel.mKeys[k];
    for (unsigned v = 0; v < key.mNumValuesAndWeights; ++v) {
      const unsigned shape = key.mValues[v];
      const auto value = static_cast<float>(key.mWeights[v]);
      if (shape >= groups.size()) continue;
      ShapeCurve& curve = curves[shape];
      if (!std::isfinite(value) || !std::isfinite(key.mTime)) {
        return Status(StatusCode::kNonFinite, "a key of a blend shape is not finite");
      }
      if (!curve.keys.empty() && key.mTime - origin < curve.keys.back().first) {
        return Status(StatusCode::kSchema, "the keys of a blend shape are not in order");
      }
      curve.keys.emplace_back(key.mTime - origin, value);
    }
  }
  for (auto& [shape, curve] : curves) {
    curve.name = groups[shape].name;
    if (curve.name.empty()) curve.name = OneLine(mesh.mName.C_Str()) + "." + std::to_string(shape);
  }
  return curves;
}

}  // namespace

float ShapeCurve::At(double ticks) const {
  const auto next = std::upper_bound(
      keys.begin(), keys.end(), ticks,
      [](double time, const std::pair<double, float>& key) { return time < key.first; });
  if (next == keys.begin()) return keys.front().second;
  if (next == keys.end()) return keys.back().second;
  const auto& [time, value] = *(next - 1);
  return std::lerp(value, next->second, static_cast<float>((ticks - time) / (next->first - time)));
}

double LastShapeKey(const aiAnimation& animation) {
  double last = 0.0;
  for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
    const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
    if (channel.mNumKeys > 0)
      last = std::max(last, channel.mKeys[channel.mNumKeys - 1].mTime - OriginOf(animation));
  }
  return std::isfinite(last) ? last : 0.0;
}

Result<std::vector<ShapeCurve>> ListShapeCurves(const aiScene& scene,
                                                const aiAnimation& animation) {
  std::vector<ShapeCurve> result;
  std::unordered_set<std::string> names;
  for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
    const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
    const aiMesh* mesh = FindShapeMesh(scene, channel.mName.C_Str());
    if (mesh == nullptr) continue;
    Result<std::map<unsigned, ShapeCurve>> curves = CurvesOf(channel, *mesh, OriginOf(animation));
    FURROW_RETURN_IF_ERROR(curves);
    for (auto& [shape, curve] : *curves) {
      if (names.insert(curve.name).second) result.push_back(std::move(curve));
    }
    if (result.size() > motion::kMaxBlendShapes) {
      return Status(StatusCode::kLimit, "the file animates more than " +
                                            std::to_string(motion::kMaxBlendShapes) +
                                            " blend shapes");
    }
  }
  return result;
}

}  // namespace furrow::authoring
