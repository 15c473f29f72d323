// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/batch_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "wrinkle/batch_kernel.h"

namespace furrow::wrinkle {
namespace {

// Fewer subjects are at home in the processor's caches.
constexpr std::size_t kPrefetchFrom = 256;

const float* Numbers(std::span<const Transform> joints) {
  return joints.empty() ? nullptr : &joints.front().translation.x;
}

std::span<const float> AllNumbers(const LocalPose& pose, const BindingData& data) {
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  if (num_joints == 0) return {};
  return {Numbers(pose.joints), num_joints * (sizeof(Transform) / sizeof(float))};
}

}  // namespace

// Adds updates lane by lane and solves whenever the lanes are full.
class BatchSolver::Grouping {
 public:
  Grouping(const BindingData& binding, std::size_t num_drivers, float* scratch)
      : num_lanes_(BatchLanes()), scratch_(scratch) {
    group_.binding = &binding;
    group_.num_values = binding.NumValues(num_drivers);
    reads_all_ = group_.num_values == binding.NumValues(kAllDrivers);
  }

  void Add(BatchUpdate* update) {
    update->status = Check(*update);
    if (update->status != JobStatus::kOk) return;
    FilterContext* const context = &update->solver->filter_context_;
    const auto lanes_end = group_.contexts.begin() + static_cast<std::ptrdiff_t>(group_.count);
    // A subject's second pose builds on its first.
    if (std::find(group_.contexts.begin(), lanes_end, context) != lanes_end) Solve();
    Put(group_.count++, update);
    if (group_.count == num_lanes_) Solve();
  }

  void Solve() {
    while (group_.count > 0) {
      for (std::size_t lane = group_.count; lane < num_lanes_; ++lane) Put(lane, updates_[0]);
      const unsigned suspect = EvaluateGroup(group_, scratch_);
      if (suspect != 0 && RemoveNonFinite(suspect)) continue;
      FinishGroup(group_, scratch_);
      group_.count = 0;
    }
  }

 private:
  // All but the numbers that EvaluateGroup() looks at.
  [[nodiscard]] JobStatus Check(const BatchUpdate& update) const {
    const BindingData& data = *group_.binding;
    const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
    if (!std::isfinite(update.dt) || update.dt < 0.0) return JobStatus::kBadTime;
    if (update.pose->joints.size() < num_joints) return JobStatus::kSizeMismatch;
    const std::span<const float> numbers = AllNumbers(*update.pose, data);
    bool finite = BatchAllFinite(update.pose->blend_shapes);
    if (reads_all_) {
      for (const NumberRange& range : data.unread) {
        finite = finite && BatchAllFinite(numbers.subspan(range.first, range.count));
      }
    } else {
      finite = finite && BatchAllFinite(numbers);
    }
    return finite ? JobStatus::kOk : JobStatus::kNonFinite;
  }

  void Put(std::size_t lane, BatchUpdate* update) {
    SubjectSolver& solver = *update->solver;
    updates_[lane] = update;
    group_.poses[lane] = update->pose->joints.data();
    group_.joints[lane] = Numbers(update->pose->joints);
    group_.blend_shapes[lane] = update->pose->blend_shapes;
    group_.filters[lane] = &solver.filter_;
    group_.contexts[lane] = &solver.filter_context_;
    group_.dt[lane] = update->dt;
    group_.raw_values[lane] = solver.raw_values_.data();
    group_.weights[lane] = solver.weights_.data();
  }

  // Takes out, of the lanes whose bits are set, those that are not finite. False: none.
  bool RemoveNonFinite(unsigned suspect) {
    std::size_t num_left = 0;
    for (std::size_t lane = 0; lane < group_.count; ++lane) {
      BatchUpdate* const update = updates_[lane];
      const bool bad = (suspect >> lane & 1u) != 0 &&
                       !BatchAllFinite(AllNumbers(*update->pose, *group_.binding));
      if (bad) {
        update->status = JobStatus::kNonFinite;
      } else {
        Put(num_left++, update);
      }
    }
    return std::exchange(group_.count, num_left) != num_left;
  }

  const std::size_t num_lanes_;
  float* const scratch_;
  BatchGroup group_;
  BatchGroup::Each<BatchUpdate*> updates_{};
  bool reads_all_ = true;
};

namespace {

void Prefetch(const float* numbers, std::size_t count) {
  constexpr std::size_t kLine = 64 / sizeof(float);
  for (std::size_t i = 0; i < count; i += kLine) __builtin_prefetch(numbers + i, 0, 2);
}

}  // namespace

// Has memory bring what an update that is soon to come will read.
void BatchSolver::Expect(const BatchUpdate& update) {
  const SubjectSolver& solver = *update.solver;
  Prefetch(Numbers(update.pose->joints),
           update.pose->joints.size() * (sizeof(Transform) / sizeof(float)));
  for (const std::vector<float>* list :
       {&solver.filter_context_.value, &solver.filter_context_.raw,
        &solver.filter_context_.derivative, &solver.raw_values_, &solver.weights_}) {
    Prefetch(list->data(), list->size());
  }
}

void BatchSolver::Run(std::span<BatchUpdate> updates) {
  waiting_.clear();
  for (BatchUpdate& update : updates) {
    const bool complete = update.solver != nullptr && update.pose != nullptr;
    update.status = complete ? JobStatus::kOk : JobStatus::kNullPointer;
    if (complete) waiting_.push_back(&update);
  }
  while (!waiting_.empty()) RunFirstKind();
}

// All that share the first one's binding and level of detail; the others go on waiting, in order.
void BatchSolver::RunFirstKind() {
  const SubjectSolver& first = *waiting_.front()->solver;
  const BindingData& data = first.binding().data();
  const std::size_t num_drivers = first.num_drivers();
  Grouping grouping(data, num_drivers, Scratch(BatchScratchSize(data)));
  std::size_t num_left = 0;
  const std::size_t ahead = waiting_.size() < kPrefetchFrom ? waiting_.size() : BatchLanes();
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    BatchUpdate* const update = waiting_[i];
    if (i + ahead < waiting_.size()) Expect(*waiting_[i + ahead]);
    const SubjectSolver& solver = *update->solver;
    if (&solver.binding().data() != &data || solver.num_drivers() != num_drivers) {
      waiting_[num_left++] = update;
      continue;
    }
    grouping.Add(update);
  }
  grouping.Solve();
  waiting_.resize(num_left);
}

JobStatus BatchSolver::SetLevel(SubjectSolver* solver, const LocalPose& pose,
                                std::size_t num_drivers) {
  const BindingData& data = solver->binding().data();
  const auto first = static_cast<std::ptrdiff_t>(data.NumValues(solver->num_drivers_));
  const auto last = static_cast<std::ptrdiff_t>(data.NumValues(num_drivers));
  solver->num_drivers_ = num_drivers;
  FilterContext& filter = solver->filter_context_;
  if (last <= first || !filter.started || filter.since_input > 0.0) return JobStatus::kOk;
  SubjectSolver newcomer(solver->binding_);  // whose first pose this is: it passes unchanged
  newcomer.num_drivers_ = num_drivers;
  BatchUpdate update{.solver = &newcomer, .pose = &pose};
  Run({&update, 1});
  if (update.status != JobStatus::kOk) return update.status;
  const auto join = [first, last](const std::vector<float>& from, std::vector<float>* to) {
    std::copy(from.begin() + first, from.begin() + last, to->begin() + first);
  };
  join(newcomer.filter_context_.value, &filter.value);
  join(newcomer.filter_context_.raw, &filter.raw);
  join(newcomer.filter_context_.derivative, &filter.derivative);
  update.solver = solver;  // no time has passed: new weights of the values as they are
  Run({&update, 1});
  return update.status;
}

float* BatchSolver::Scratch(std::size_t size) {
  constexpr std::size_t kSlack = kBatchAlignment / sizeof(float);
  if (scratch_.size() < size + kSlack) scratch_.resize(size + kSlack);
  const auto address = reinterpret_cast<std::uintptr_t>(scratch_.data());
  const std::size_t past = address % kBatchAlignment / sizeof(float);
  return scratch_.data() + (past == 0 ? 0 : kSlack - past);
}

}  // namespace furrow::wrinkle
