// SPDX-License-Identifier: Apache-2.0
// Measures solving many subjects of one rig: 60 pose drivers with 2 and with 8 reference poses, for
// 1, 100 and 10,000 subjects that move in every frame. The baseline copies the same poses, which is
// the cost of memory access alone.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/batch_solver.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {
namespace {

constexpr int kNumDrivers = 60;

// A head with one leaf joint per driver, placed on a sphere.
Skeleton Face() {
  std::vector<JointDesc> joints(2);
  joints[0].name = "neck";
  joints[1].name = "head";
  joints[1].parent = 0;
  joints[1].rest.translation = {0.0f, 0.1f, 0.0f};
  for (int i = 0; i < kNumDrivers; ++i) {
    const float angle = static_cast<float>(i) * 2.4f;
    const float height = static_cast<float>(i) / kNumDrivers - 0.5f;
    JointDesc joint;
    joint.name = "muscle" + std::to_string(i);
    joint.parent = 1;
    joint.rest.translation = {0.08f * std::cos(angle), 0.1f * height, 0.08f * std::sin(angle)};
    joint.tail = joint.rest.translation * 0.3f;
    joints.push_back(joint);
  }
  return Skeleton::Create(joints).value();
}

glm::quat PoseRotation(int joint, int pose) {
  const float a = static_cast<float>(joint * 7 + pose * 13);
  return glm::angleAxis(0.3f, glm::normalize(glm::vec3(std::sin(a), std::cos(a * 1.7f), 0.5f)));
}

Rig FaceRig(int num_poses, PoseSolve solve) {
  Rig rig;
  rig.anchor = "head";
  rig.wrinkle_maps = {{.name = "squash"}};
  for (int k = 0; k < num_poses; ++k) {
    ReferencePose pose;
    pose.name = "pose" + std::to_string(k);
    for (int i = 0; i < kNumDrivers; ++i) {
      pose.joints.push_back({"muscle" + std::to_string(i), PoseRotation(i, k)});
    }
    rig.reference_poses.push_back(pose);
  }
  for (int i = 0; i < kNumDrivers; ++i) {
    Driver driver;
    driver.name = "driver" + std::to_string(i);
    driver.pose.points = {{.joint = "muscle" + std::to_string(i)}};
    driver.pose.solve = solve;
    Region region;
    region.name = "region" + std::to_string(i);
    region.feeds = {{.map = "squash"}};
    for (int k = 0; k < num_poses; ++k) {
      const std::string pose = "pose" + std::to_string(k);
      driver.pose.values.push_back({pose, pose});
      region.feeds[0].sources.push_back({driver.name, pose});
    }
    rig.drivers.push_back(driver);
    rig.regions.push_back(region);
  }
  return rig;
}

std::vector<LocalPose> Poses(const Skeleton& skeleton, int count) {
  std::vector<LocalPose> poses(static_cast<std::size_t>(count));
  for (int subject = 0; subject < count; ++subject) {
    LocalPose& pose = poses[static_cast<std::size_t>(subject)];
    pose.SetRest(skeleton);
    for (int i = 0; i < kNumDrivers; ++i) {
      pose.joints[static_cast<std::size_t>(i + 2)].rotation = PoseRotation(i, subject % 17);
    }
  }
  return poses;
}

void SetCounters(benchmark::State& state, int subjects, int joints) {
  state.SetItemsProcessed(state.iterations() * subjects);
  state.SetBytesProcessed(state.iterations() * subjects * joints *
                          static_cast<std::int64_t>(sizeof(Transform)));
}

// range(1) subjects of one binding with range(0) reference poses. In every frame each subject takes
// the pose of its neighbour. So all subjects move, and the memory read per frame equals that of
// newly received poses.
struct Subjects {
  Subjects(const benchmark::State& state, PoseSolve solve)
      : poses(Poses(skeleton, std::max(static_cast<int>(state.range(1)), 2))) {
    const Rig rig = FaceRig(static_cast<int>(state.range(0)), solve);
    const auto binding = std::make_shared<const RigBinding>(
        std::move(RigBinding::Create(rig, skeleton, {})).value());
    solvers.assign(static_cast<std::size_t>(state.range(1)), SubjectSolver(binding));
  }
  [[nodiscard]] const LocalPose& Pose(std::size_t subject, std::size_t frame) const {
    return poses[(subject + frame % 2) % poses.size()];
  }

  const Skeleton skeleton = Face();
  const std::vector<LocalPose> poses;
  std::vector<SubjectSolver> solvers;
};

void Solve(benchmark::State& state, PoseSolve solve) {
  Subjects subjects(state, solve);
  std::size_t frame = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < subjects.solvers.size(); ++i) {
      if (subjects.solvers[i].Update(subjects.Pose(i, frame), 1.0 / 60.0) != JobStatus::kOk)
        state.SkipWithError("solver");
    }
    ++frame;
    benchmark::DoNotOptimize(subjects.solvers.front().wrinkle_weights().data());
  }
  SetCounters(state, static_cast<int>(subjects.solvers.size()), subjects.skeleton.num_joints());
}

void SolveBatch(benchmark::State& state, PoseSolve solve) {
  Subjects subjects(state, solve);
  std::vector<BatchUpdate> frames[2];
  for (std::size_t i = 0; i < subjects.solvers.size(); ++i) {
    for (std::size_t frame = 0; frame < 2; ++frame) {
      frames[frame].push_back(
          {.solver = &subjects.solvers[i], .pose = &subjects.Pose(i, frame), .dt = 1.0 / 60.0});
    }
  }
  BatchSolver batch;
  std::size_t frame = 0;
  for (auto _ : state) {
    std::vector<BatchUpdate>& updates = frames[frame++ % 2];
    batch.Run(updates);
    if (updates.back().status != JobStatus::kOk) state.SkipWithError("batch");
  }
  SetCounters(state, static_cast<int>(subjects.solvers.size()), subjects.skeleton.num_joints());
}

void BM_BatchProjection(benchmark::State& state) { SolveBatch(state, PoseSolve::kProjection); }
void BM_BatchNnls(benchmark::State& state) { SolveBatch(state, PoseSolve::kNnls); }
void BM_SolveProjection(benchmark::State& state) { Solve(state, PoseSolve::kProjection); }
void BM_SolveNnls(benchmark::State& state) { Solve(state, PoseSolve::kNnls); }

void BM_CopyPoses(benchmark::State& state) {
  const Skeleton skeleton = Face();
  const std::vector<LocalPose> poses = Poses(skeleton, static_cast<int>(state.range(0)));
  std::vector<LocalPose> copies = poses;
  for (auto _ : state) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      std::memcpy(static_cast<void*>(copies[i].joints.data()), poses[i].joints.data(),
                  poses[i].joints.size() * sizeof(Transform));
    }
    benchmark::ClobberMemory();
  }
  SetCounters(state, static_cast<int>(state.range(0)), skeleton.num_joints());
}

void BM_LocalToModel(benchmark::State& state) {
  const Skeleton skeleton = Face();
  const std::vector<LocalPose> poses = Poses(skeleton, static_cast<int>(state.range(0)));
  std::vector<glm::mat4> model(static_cast<std::size_t>(skeleton.num_joints()));
  for (auto _ : state) {
    for (const LocalPose& pose : poses) {
      const LocalToModelJob job{.skeleton = &skeleton, .local = pose.joints, .model = model};
      if (job.Run() != JobStatus::kOk) state.SkipWithError("the local-to-model job failed");
    }
    benchmark::ClobberMemory();
  }
  SetCounters(state, static_cast<int>(state.range(0)), skeleton.num_joints());
}

const std::vector<std::int64_t> kSubjects = {1, 100, 10000};

BENCHMARK(BM_SolveProjection)->ArgNames({"poses", "subjects"})->ArgsProduct({{2, 8}, kSubjects});
BENCHMARK(BM_BatchProjection)->ArgNames({"poses", "subjects"})->ArgsProduct({{2, 8}, kSubjects});
BENCHMARK(BM_SolveNnls)->ArgNames({"poses", "subjects"})->ArgsProduct({{2, 8}, kSubjects});
BENCHMARK(BM_BatchNnls)->ArgNames({"poses", "subjects"})->ArgsProduct({{2, 8}, kSubjects});
BENCHMARK(BM_CopyPoses)->ArgName("subjects")->Arg(1)->Arg(100)->Arg(10000);
BENCHMARK(BM_LocalToModel)->ArgName("subjects")->Arg(1)->Arg(100)->Arg(10000);

}  // namespace
}  // namespace furrow::wrinkle
