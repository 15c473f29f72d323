// SPDX-License-Identifier: Apache-2.0
#include "daemon_fixture.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <utility>

#include "motion/pose_source.h"
#include "protocol/messages/hash.h"
#include "protocol/mocap/livelink_face.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::testing_net {

void DaemonThread::AwaitCount(server::Counter counter, std::uint64_t least) const {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (Count(counter) < least && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_GE(Count(counter), least);
}

DaemonThread::DaemonThread(server::Config config) : config_(std::move(config)) {
  const char* const threads = std::getenv("FURROW_TEST_THREADS");
  if (threads != nullptr && config_.threads == 1) config_.threads = std::atoi(threads);
  std::promise<std::optional<server::Ready>> ready;
  std::future<std::optional<server::Ready>> is_ready = ready.get_future();
  std::promise<server::ExitCode> exit_code;
  exit_code_ = exit_code.get_future();
  thread_ =
      std::jthread([this, ready = std::move(ready), exit_code = std::move(exit_code)]() mutable {
        bool served = false;
        server::RunOptions options;
        options.stop = stop_.get_token();
        options.metrics = &metrics_;
        options.on_ready = [&](const server::Ready& where) {
          served = true;
          ready.set_value(where);
        };
        const server::ExitCode code = server::Run(config_, options);
        if (!served) ready.set_value(std::nullopt);
        exit_code.set_value(code);
      });
  ready_ = is_ready.get();
}

DaemonThread::~DaemonThread() {
  const server::ExitCode code = Stop();
  if (serves()) {
    EXPECT_EQ(code, server::ExitCode::kOk);
  }
}

server::ExitCode DaemonThread::Stop() {
  stop_.request_stop();
  if (!ended_) ended_ = exit_code_.get();
  return *ended_;
}

server::Config WeightsConfig(const std::string& rig) {
  server::Config config;
  config.rig = std::filesystem::path(FURROW_SOURCE_DIR) / "rig" / "rigs" / rig;
  config.tcp = 0;
  config.udp = 0;
  config.http.port = 0;
  config.http.api_share = 1.0;  // tests ask without pause
  config.http.requests_per_second = 1'000'000;
  config.render = false;
  return config;
}

protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject) {
  protocol::SkeletonOffer offer;
  offer.subject = subject;
  const wrinkle::Skeleton& skeleton = clip.skeleton;
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const wrinkle::Transform& rest = skeleton.rest_pose()[j];
    const glm::vec3 tail = skeleton.tails()[j];
    protocol::OfferedJoint joint;
    joint.name = skeleton.joint_names()[j];
    joint.parent = skeleton.joint_parents()[j];
    joint.rest_translation = {rest.translation.x, rest.translation.y, rest.translation.z};
    joint.rest_rotation = {rest.rotation.x, rest.rotation.y, rest.rotation.z, rest.rotation.w};
    joint.rest_scale = {rest.scale.x, rest.scale.y, rest.scale.z};
    joint.has_tail = true;
    joint.tail = {tail.x, tail.y, tail.z};
    offer.joints.push_back(joint);
  }
  offer.blend_shape_names = clip.blend_shape_names;
  offer.skeleton_hash = protocol::SkeletonHash(offer);
  return offer;
}

protocol::PoseFrame PoseOf(const motion::Clip& clip, int frame,
                           const protocol::SkeletonOffer& offer) {
  wrinkle::LocalPose local;
  clip.GetPose(frame, &local);
  protocol::PoseFrame pose;
  pose.skeleton_hash = offer.skeleton_hash;
  pose.num_joints = static_cast<std::uint16_t>(offer.joints.size());
  pose.num_blend_shapes = static_cast<std::uint16_t>(offer.blend_shape_names.size());
  for (std::uint16_t j = 0; j < pose.num_joints; ++j) {
    const wrinkle::Transform& joint = local.joints[j];
    const glm::vec3 offset = joint.translation - clip.skeleton.rest_pose()[j].translation;
    pose.rotation_joints.push_back(j);
    pose.rotations.push_back(
        {joint.rotation.x, joint.rotation.y, joint.rotation.z, joint.rotation.w});
    pose.translation_joints.push_back(j);
    pose.translations.push_back({offset.x, offset.y, offset.z});
  }
  for (std::uint16_t s = 0; s < pose.num_blend_shapes; ++s) {
    pose.blend_shape_indices.push_back(s);
    pose.blend_shapes.push_back(local.blend_shapes[s]);
  }
  return pose;
}

motion::Clip ArkitClip(int num_frames) {
  motion::Clip clip;
  clip.name = "arkit";
  for (const std::string_view name : protocol::mocap::LiveLinkFaceShapeNames().first(52)) {
    std::string spelled(name);
    spelled[0] = static_cast<char>(std::tolower(spelled[0]));
    clip.blend_shape_names.push_back(spelled);
  }
  for (int frame = 0; frame < num_frames; ++frame) {
    const double time = frame / 60.0;
    clip.times.push_back(time);
    for (int shape = 0; shape < 52; ++shape) {
      clip.blend_shapes.push_back(
          static_cast<float>(0.5 - 0.5 * std::cos(time * (1.0 + 0.1 * shape))));
    }
  }
  return clip;
}

std::vector<std::vector<float>> Solve(const motion::Clip& clip, const std::string& rig_name) {
  const auto path = std::filesystem::path(FURROW_SOURCE_DIR) / "rig" / "rigs" / rig_name;
  auto rig = rig::LoadRig(path, motion::CachedPoseSource());
  EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  auto binding = wrinkle::RigBinding::Create(*rig, clip.skeleton, clip.blend_shape_names,
                                             {.allow_missing = true});
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)));
  std::vector<std::vector<float>> weights;
  wrinkle::LocalPose pose;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    clip.GetPose(frame, &pose);
    const double dt = frame == 0 ? 0.0 : clip.times[frame] - clip.times[frame - 1];
    EXPECT_EQ(solver.Update(pose, dt), wrinkle::JobStatus::kOk);
    weights.emplace_back(solver.wrinkle_weights().begin(), solver.wrinkle_weights().end());
  }
  return weights;
}

void Offer(RawClient& client, const protocol::SkeletonOffer& offer, std::uint16_t stream) {
  ASSERT_TRUE(client.Introduce());
  client.Send(offer, stream);
  while (auto received = client.Next()) {
    protocol::ErrorMessage error;
    if (protocol::Decode(received->view, error) == protocol::DecodeStatus::kOk) {
      // The subject still belongs to the sender before, until the daemon notices that it is silent.
      ASSERT_EQ(error.code, protocol::ErrorCode::kSubjectTaken) << error.message;
      client.Send(offer, stream);
    }
    protocol::SkeletonReply reply;
    if (protocol::Decode(received->view, reply) != protocol::DecodeStatus::kOk) continue;
    ASSERT_EQ(reply.status, protocol::SkeletonStatus::kAccepted) << reply.message;
    return;
  }
  FAIL() << "no answer to the offer";
}

std::optional<protocol::SubscribeReply> Watch(RawClient& client,
                                              const protocol::SubscribeWeights& request,
                                              std::uint32_t sequence) {
  client.Send(request, 0, sequence);
  while (auto received = client.Next()) {
    protocol::SubscribeReply reply;
    if (protocol::Decode(received->view, reply) == protocol::DecodeStatus::kOk) return reply;
    if (received->view.kind == protocol::MessageKind::kError) {
      client.skipped.push_back(*std::move(received));
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace furrow::testing_net
