// SPDX-License-Identifier: Apache-2.0
// Measures solving the default recording with the default rig: drivers of every kind in realistic
// poses of body and face. Each subject starts at another frame and advances by one frame per
// update.
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/data_dir.h"
#include "bench/report/value_or_exit.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/batch_solver.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {
namespace {

using bench::ValueOrExit;

// Loaded once for all benchmarks.
struct Performance {
  Performance() {
    const Rig rig = ValueOrExit(rig::LoadRig(ValueOrExit(furrow::FindDataFile("rigs/default.json")),
                                             motion::CachedPoseSource()));
    const auto clip = ValueOrExit(
        motion::LoadClip(ValueOrExit(furrow::FindDataFile("recordings/performance.bvh"))));
    binding = std::make_shared<const RigBinding>(ValueOrExit(
        RigBinding::Create(rig, clip.skeleton, clip.blend_shape_names, {.allow_missing = true})));
    frames.resize(static_cast<std::size_t>(clip.num_frames()));
    for (int i = 0; i < clip.num_frames(); ++i) {
      clip.GetPose(i, &frames[static_cast<std::size_t>(i)]);
    }
  }

  std::shared_ptr<const RigBinding> binding;
  std::vector<LocalPose> frames;
};

// range(0) subjects, each with its own poses.
class Cast {
 public:
  explicit Cast(const benchmark::State& state) {
    static const Performance performance;
    performance_ = &performance;
    solvers.assign(static_cast<std::size_t>(state.range(0)), SubjectSolver(performance.binding));
    for (std::size_t i = 0; i < solvers.size(); ++i) places_.push_back(i * 37);
  }

  const LocalPose& NextPose(std::size_t subject) {
    std::size_t& place = places_[subject];
    place = (place + 1) % performance_->frames.size();
    return performance_->frames[place];
  }

  std::vector<SubjectSolver> solvers;

 private:
  const Performance* performance_ = nullptr;
  std::vector<std::size_t> places_;
};

void BM_SolveShippedRig(benchmark::State& state) {
  Cast cast(state);
  for (auto _ : state) {
    for (std::size_t i = 0; i < cast.solvers.size(); ++i) {
      if (cast.solvers[i].Update(cast.NextPose(i), 1.0 / 60.0) != JobStatus::kOk) {
        state.SkipWithError("solver");
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BM_BatchShippedRig(benchmark::State& state) {
  Cast cast(state);
  std::vector<BatchUpdate> updates(cast.solvers.size());
  BatchSolver batch;
  for (auto _ : state) {
    for (std::size_t i = 0; i < updates.size(); ++i) {
      updates[i] = {.solver = &cast.solvers[i], .pose = &cast.NextPose(i), .dt = 1.0 / 60.0};
    }
    batch.Run(updates);
    if (updates.back().status != JobStatus::kOk) state.SkipWithError("batch");
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_SolveShippedRig)->ArgName("subjects")->Arg(1)->Arg(16)->Arg(100);
BENCHMARK(BM_BatchShippedRig)->ArgName("subjects")->Arg(1)->Arg(16)->Arg(100);

}  // namespace
}  // namespace furrow::wrinkle
