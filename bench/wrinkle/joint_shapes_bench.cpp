// SPDX-License-Identifier: Apache-2.0
// Measures how the shipped recording, whose face has joints, moves the shapes of the default head
// with ARKit's 52 shapes: the solve that comes before the rig's for such streams.
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/default_character.h"
#include "base/data_dir.h"
#include "bench/report/value_or_exit.h"
#include "character/mesh/moved_surface.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "rig/shapes/face_joints.h"
#include "rig/skeleton_match.h"

namespace furrow::wrinkle {
namespace {

using bench::ValueOrExit;

// Loaded once for all benchmarks.
struct ShapedHead {
  ShapedHead() {
    const Rig rig = ValueOrExit(rig::LoadRig(ValueOrExit(furrow::FindDataFile("rigs/default.json")),
                                             motion::CachedPoseSource()));
    auto character = authoring::MakeDefaultCharacter(rig, {.texture_size = 64});
    if (!authoring::MakeBlendShapeFace(&character).ok()) std::abort();
    const auto clip = ValueOrExit(
        motion::LoadClip(ValueOrExit(furrow::FindDataFile("recordings/performance.bvh"))));
    const auto joints = ValueOrExit(rig::SkeletonMatcher::Create(""));
    const auto match = joints.Match(clip.skeleton, rig, &character.skeleton);
    const Retarget retarget = rig::MakeRetarget(match, clip.skeleton, character.skeleton);
    shapes = rig::MatchFaceJoints(
        {clip.skeleton, match.stream.roles, match.turn(), retarget.unmatched_source()},
        {character.skeleton, match.character.roles, character::FindMovedSurface(character.meshes),
         character.shapes, character.shape_rules},
        ValueOrExit(rig::ShapeMatcher::Create("")));
    weights.resize(character.shapes.size());
    frames.resize(static_cast<std::size_t>(clip.num_frames()));
    for (int i = 0; i < clip.num_frames(); ++i) {
      clip.GetPose(i, &frames[static_cast<std::size_t>(i)]);
    }
  }

  JointShapes shapes;
  std::vector<LocalPose> frames;
  std::vector<float> weights;
};

void BM_JointShapes(benchmark::State& state) {
  static ShapedHead head;
  if (head.shapes.empty()) state.SkipWithError("no joint moves a shape");
  std::size_t frame = 0;
  for (auto _ : state) {
    if (head.shapes.Run(head.frames[frame].joints, head.weights) != JobStatus::kOk) {
      state.SkipWithError("solver");
    }
    frame = (frame + 1) % head.frames.size();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_JointShapes);

}  // namespace
}  // namespace furrow::wrinkle
