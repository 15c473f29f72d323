// SPDX-License-Identifier: Apache-2.0
#include "recording/take_poses.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "base/ascii.h"
#include "base/joined.h"
#include "base/status.h"
#include "base/text.h"
#include "motion/clip/limits.h"

namespace furrow::recording {
namespace {

using protocol::DecodeStatus;

constexpr std::size_t kMaxPoseBytes = std::size_t{2} << 30;
constexpr char kExtension[] = ".mcap";

using Names = std::set<std::string, std::less<>>;

bool EndsInMcap(std::string_view text) {
  return text.size() > std::string_view(kExtension).size() &&
         EqualsIgnoreCase(text.substr(text.size() - 5), kExtension);
}

Status NoPoses(const TakeReader& take, std::string_view subject, const Names& names) {
  const std::string file = take.path().string();
  if (names.contains(subject) || (subject.empty() && !names.empty()))
    return {StatusCode::kNotFound, "none of its poses is readable", file};
  if (subject.empty() || names.empty()) {
    return {StatusCode::kNotFound, "the take has no poses", file};
  }
  return {StatusCode::kNotFound, "the take has no poses of '" + std::string(subject) + "'", file,
          "its subjects are: " + Joined(names)};
}

// "take.mcap: skipped 2 <one>s of 'ada'<why>".
void WarnSkipped(motion::ClipReport* report, const TakeReader& take, std::size_t count,
                 const std::string& one, const std::string& subject, const std::string& why) {
  if (report == nullptr || count == 0) return;
  report->warnings.push_back(take.path().string() + ": skipped " + Counted(count, one) + " of '" +
                             subject + "'" + why);
}

}  // namespace

// Microseconds from the last pose to the pose with `stamp`, at least 1.
std::int64_t TakePoses::StepTo(const TakeStamp& stamp) const {
  // Microseconds. A longer step counts as a leap of the sender's clock, unless at least a
  // thousandth of it (kFastest) passed at arrival.
  constexpr std::int64_t kLeap = 60'000'000;
  constexpr std::int64_t kFastest = 1000;               // maximum of `furrow play --speed`
  constexpr std::int64_t kLongest = 1'000'000'000'000;  // 11 days, so that sums cannot overflow
  // The reader sorts by log time. Capture times are whatever the sender stated.
  const auto arrived = static_cast<std::int64_t>((stamp.log_time_ns - last_.log_time_ns) / 1000);
  std::int64_t step = 0;
  const bool is_broken =
      __builtin_sub_overflow(stamp.capture_time_us, last_.capture_time_us, &step) ||
      stamp.session != last_.session || step <= 0 || (step > kLeap && step / kFastest > arrived);
  return std::clamp<std::int64_t>(is_broken ? arrived : step, 1, kLongest);
}

void TakePoses::Add(const TakeMessage& message) {
  if (!times_.empty()) elapsed_us_ += StepTo(message.stamp);
  last_ = message.stamp;
  times_.push_back(static_cast<double>(elapsed_us_) * 1e-6);
  bytes_.insert(bytes_.end(), message.payload.begin(), message.payload.end());
  ends_.push_back(bytes_.size());
}

// Distributes the messages of a take to its subjects. With an empty `subject` it collects all
// subjects, or the only one.
class TakePoses::Loader {
 public:
  Loader(std::string_view subject, bool only_one) : subject_(subject), only_one_(only_one) {}

  // Returns false if the poses exceed the limits.
  bool Add(const TakeMessage& message) {
    if (message.kind != TakeKind::kSkeleton && message.kind != TakeKind::kPose) return true;
    // Collected even for other subjects: errors list them.
    if (message.kind == TakeKind::kPose && !names_.contains(message.subject))
      names_.emplace(message.subject);
    if (is_ambiguous() || (!subject_.empty() && message.subject != subject_)) return true;
    auto found = tracks_.find(message.subject);
    if (found == tracks_.end())
      found = tracks_.emplace(std::string(message.subject), Track()).first;
    Track& track = found->second;
    if (message.kind == TakeKind::kPose) return AddPose(message, &track);
    // The first skeleton counts. Poses of a later one are counted as foreign.
    if (track.has_offer) return true;
    track.has_offer = protocol::Decode(message.View(), track.poses.offer_) == DecodeStatus::kOk;
    track.unreadable += track.has_offer ? 0 : 1;
    return true;
  }

  // All subjects with poses.
  [[nodiscard]] const Names& names() const { return names_; }
  // Whether the caller wants one subject, named none, and the take has several.
  [[nodiscard]] bool is_ambiguous() const {
    return only_one_ && subject_.empty() && names_.size() > 1;
  }

  // The subjects with poses, in order of their first poses.
  std::vector<TakePoses> Finish(const TakeReader& take, motion::ClipReport* report) {
    std::vector<Track*> order;
    for (auto& [name, track] : tracks_) {
      WarnSkipped(report, take, track.unreadable, "unreadable message", name, "");
      WarnSkipped(report, take, track.foreign, "pose", name, ": not of its first skeleton");
      if (track.poses.size() > 0) order.push_back(&track);
    }
    std::ranges::stable_sort(order, {}, &Track::first_ns);
    std::vector<TakePoses> all;
    for (Track* track : order) {
      track->poses.start_ = static_cast<double>(track->first_ns - order.front()->first_ns) * 1e-9;
      all.push_back(std::move(track->poses));
    }
    return all;
  }

 private:
  struct Track {
    TakePoses poses;
    std::uint64_t first_ns = 0;
    bool has_offer = false;
    std::size_t unreadable = 0;
    std::size_t foreign = 0;
  };

  bool AddPose(const TakeMessage& message, Track* track) {
    const protocol::SkeletonOffer& offer = track->poses.offer_;
    if (protocol::Decode(message.View(), pose_) != DecodeStatus::kOk) {
      ++track->unreadable;
    } else if (!track->has_offer || pose_.skeleton_hash != offer.skeleton_hash ||
               pose_.num_joints != offer.joints.size() ||
               pose_.num_blend_shapes != offer.blend_shape_names.size()) {
      ++track->foreign;
    } else {
      if (track->poses.size() == 0) track->first_ns = message.stamp.log_time_ns;
      track->poses.Add(message);
      num_bytes_ += message.payload.size();
      return num_bytes_ <= kMaxPoseBytes && track->poses.size() <= motion::kMaxFrames;
    }
    return true;
  }

  std::string_view subject_;
  bool only_one_;
  Names names_;
  std::map<std::string, Track, std::less<>> tracks_;
  std::size_t num_bytes_ = 0;
  protocol::PoseFrame pose_;  // a member to reuse its memory
};

Result<std::vector<TakePoses>> TakePoses::LoadOf(TakeReader& take, std::string_view subject,
                                                 bool only_one, motion::ClipReport* report) {
  Loader loader(subject, only_one);
  bool fits = true;
  Status status = take.ForEach([&](const TakeMessage& message) {
    fits = loader.Add(message);
    return fits;
  });
  if (!status.ok()) return status;
  if (!fits) {
    return Status(StatusCode::kLimit, "the take has too many poses", take.path().string(),
                  "record with --rotate-seconds for shorter files");
  }
  const Names& names = loader.names();
  if (loader.is_ambiguous()) {
    return Status(
        StatusCode::kInvalidArgument, "the take has several subjects: " + Joined(names),
        take.path().string(),
        "choose one, for example " + take.path().filename().string() + "#" + *names.begin());
  }
  std::vector<TakePoses> all = loader.Finish(take, report);
  for (const std::string& text : take.file().warnings())
    if (report != nullptr) report->warnings.push_back(text);
  if (all.empty()) return NoPoses(take, subject, names);
  return all;
}

Result<std::vector<TakePoses>> TakePoses::LoadAll(TakeReader& take, std::string_view subject,
                                                  motion::ClipReport* report) {
  return LoadOf(take, subject, /*only_one=*/false, report);
}

Result<TakePoses> TakePoses::Load(TakeReader& take, std::string_view subject,
                                  motion::ClipReport* report) {
  auto all = LoadOf(take, subject, /*only_one=*/true, report);
  FURROW_RETURN_IF_ERROR(all);
  return std::move(all->front());
}

void TakePoses::Get(std::size_t index, protocol::PoseFrame* pose) const {
  const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
  const protocol::MessageView view{
      {}, protocol::MessageKind::kPose, std::span(bytes_).subspan(begin, ends_[index] - begin)};
  if (protocol::Decode(view, *pose) != DecodeStatus::kOk) *pose = {};
}

bool IsTakePath(const std::string& path) {
  std::string file;
  std::string subject;
  SplitTakePath(path, &file, &subject);
  return EndsInMcap(file);
}

void SplitTakePath(const std::string& path, std::string* file, std::string* subject) {
  *file = path;
  subject->clear();
  std::error_code error;
  if (std::filesystem::exists(path, error)) return;
  for (std::size_t hash = path.find('#'); hash != std::string::npos;
       hash = path.find('#', hash + 1)) {
    if (!EndsInMcap(std::string_view(path).substr(0, hash))) continue;
    *file = path.substr(0, hash);
    *subject = path.substr(hash + 1);
    return;
  }
}

}  // namespace furrow::recording
