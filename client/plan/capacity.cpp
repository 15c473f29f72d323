// SPDX-License-Identifier: Apache-2.0
#include "client/plan/capacity.h"

#include <algorithm>
#include <cmath>

namespace furrow::plan {
namespace {

// Figures of docs/PERFORMANCE.md.
constexpr double kSealedFactor = 1.23;  // processor time of a pose and its weights, sealed to plain
// One picture with skin shading, without GPU: 131 ms for 640x400.
constexpr double kDrawSecondsPerPixel = 0.131 / (640.0 * 400.0);
// H.264 of a turning face at 1280x720: 6.74 ms and 1.41 Mbit/s at 30 Hz.
constexpr double kEncodeSecondsPerPixel = 6.74e-3 / (1280.0 * 720.0);
constexpr double kBitsPerPixel = 1.41e6 / 30.0 / (1280.0 * 720.0);

// Pictures per second of one GPU, over their pixels: skin shading on an NVIDIA H100.
const Curve& GpuPictures() {
  static const Curve curve{
      {{640.0 * 400.0, 148.0}, {1280.0 * 720.0, 115.0}, {1920.0 * 1080.0, 57.0}}};
  return curve;
}

// Processor time of a pose with its weights on a core that takes `rate` poses per second.
double PoseMicroseconds(const Demand& demand, const Costs& costs, double rate) {
  const double us = costs.pose_us.At(rate) +
                    costs.joint_us * std::max(0, demand.joints - Costs::kJoints) +
                    costs.weight_us * std::max(0, demand.weights - Costs::kWeights) +
                    costs.subscriber_us * (demand.subscribers - 1);
  // Nobody has measured a daemon without subscribers.
  return std::max(us, 1.0) * (demand.is_sealed ? kSealedFactor : 1.0);
}

// Poses per second that keep a core busy for `load` of its time.
double RateOfCore(const Demand& demand, const Costs& costs, double load) {
  // More poses need more time, although each of them needs less.
  double low = 0.0, high = 1e7;
  for (int i = 0; i < 60; ++i) {
    const double rate = 0.5 * (low + high);
    const bool fits = rate * PoseMicroseconds(demand, costs, rate) <= load * 1e6;
    (fits ? low : high) = rate;
  }
  return low;
}

void PlanPictures(const Demand& demand, const Machine& machine, Capacity* plan) {
  const double pixels = static_cast<double>(demand.width) * demand.height;
  const double pictures = demand.viewers * demand.picture_rate;
  plan->encoding_cores = pictures * pixels * kEncodeSecondsPerPixel / machine.load;
  plan->picture_cores =
      plan->encoding_cores + pictures * pixels * kDrawSecondsPerPixel / machine.load;
  plan->gpus = pictures / (GpuPictures().At(pixels) * machine.load);
  plan->bits_out += pictures * pixels * kBitsPerPixel;
}

}  // namespace

double Capacity::per_machine() const { return std::min(by_processor, by_network); }

Capacity MakePlan(const Demand& demand, const Costs& costs, const Machine& machine) {
  Capacity plan{.pose = PoseSize(demand), .weights = WeightsSize(demand)};
  plan.poses = demand.performers * demand.rate;
  plan.messages_out = plan.poses * demand.subscribers;
  plan.bits_in = 8.0 * plan.pose.bytes * plan.poses;
  plan.bits_out = 8.0 * plan.weights.bytes * plan.messages_out;
  const double core_rate = RateOfCore(demand, costs, machine.load);
  plan.cores = std::ceil(plan.poses / core_rate - 1e-9);  // the search stops just below
  plan.pose_us = PoseMicroseconds(demand, costs, std::min(plan.poses, core_rate));
  plan.busy_cores = plan.poses * plan.pose_us * 1e-6;
  plan.bytes = costs.idle_bytes + demand.performers * costs.subject_bytes;
  plan.by_processor = std::floor(machine.cores * core_rate / demand.rate);
  // A link carries both directions at the same time.
  const double bytes =
      std::max(plan.pose.bytes, plan.weights.bytes * std::max(demand.subscribers, 0));
  plan.by_network = std::floor(machine.gigabits * 1e9 * machine.load / (8.0 * bytes * demand.rate));
  if (plan.per_machine() >= 1.0) plan.machines = std::ceil(demand.performers / plan.per_machine());
  PlanPictures(demand, machine, &plan);
  return plan;
}

}  // namespace furrow::plan
