// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_mailbox.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "render/passes/picture_cost.h"

namespace furrow::server {
namespace {

constexpr int kStillQuality = 92;  // the encoder subsamples chroma below 90

// Adds the recipients of `from` to the newer job `into`, which replaces it. A subscription in both
// keeps its newer ticket. A still becomes a normal picture if the subject has moved since.
void MergeTickets(const RenderJob& from, RenderJob* into) {
  const bool rests = from.moved_at == into->moved_at;
  for (PictureTicket ticket : from.tickets) {
    ticket.still &= rests;
    const auto same =
        std::ranges::find(into->tickets, ticket.subscription, &PictureTicket::subscription);
    if (same == into->tickets.end()) into->tickets.push_back(ticket);
  }
}

// True if one picture serves both jobs; the pose may differ, since the newest wins.
bool IsSamePicture(const RenderJob& a, const RenderJob& b) {
  return a.subject == b.subject && a.spec == b.spec;
}

}  // namespace

bool PictureSpec::operator==(const PictureSpec& other) const {
  return view == other.view && settings == other.settings && width == other.width &&
         height == other.height && camera.position == other.camera.position &&
         camera.target == other.camera.target &&
         camera.fov_y_degrees == other.camera.fov_y_degrees &&
         camera.fit_shorter_side == other.camera.fit_shorter_side &&
         camera.follow_joint == other.camera.follow_joint &&
         camera.turn_joint == other.camera.turn_joint;
}

void PictureSpec::Describe(render::FrameRequest* request) const {
  if (settings != nullptr) request->settings = *settings;
  request->settings.view = view;
  request->camera = camera;
  request->width = width;
  request->height = height;
}

Encoding EncodingOf(const PictureTicket& ticket) {
  Encoding encoding = ticket.encoding;
  if (ticket.still && encoding.format == render::ImageFormat::kJpeg) {
    encoding.quality = kStillQuality;
  }
  return encoding;
}

bool RenderJob::IsStill() const { return std::ranges::any_of(tickets, &PictureTicket::still); }

bool RenderJob::IsLossy() const {
  return std::ranges::all_of(tickets, [](const PictureTicket& ticket) {
    return !ticket.still && ticket.encoding.format == render::ImageFormat::kJpeg;
  });
}

bool RenderJob::TakesDraft() const {
  return !tickets.empty() && IsLossy() &&
         std::ranges::all_of(tickets, &PictureTicket::acknowledges);
}

double RenderJob::Work() const {
  static const render::Settings kDefaults;
  return render::EstimateCost(spec.settings == nullptr ? kDefaults : *spec.settings, spec.width,
                              spec.height, IsStill() ? kStillSamples : 1)
      .work;
}

// A viewer that changes its view faster than pictures are rendered occupies one place only.
void RenderMailbox::DropOlderTickets(const RenderJob& job) {
  if (job.tickets.empty()) return;
  const auto is_superseded = [&job](const PictureTicket& ticket) {
    return std::ranges::find(job.tickets, ticket.subscription, &PictureTicket::subscription) !=
           job.tickets.end();
  };
  // Also erases jobs that have lost their last ticket: nobody would see them.
  std::erase_if(jobs_, [&](RenderJob& other) {
    if (IsSamePicture(other, job)) return false;
    return std::erase_if(other.tickets, is_superseded) > 0 && other.tickets.empty();
  });
}

RenderMailbox::PutResult RenderMailbox::Put(RenderJob&& job) {
  const std::lock_guard lock(mutex_);
  if (closed_) return PutResult::kFull;
  DropOlderTickets(job);
  // At most `capacity` jobs wait, so a search is fast enough.
  const auto waiting = std::find_if(jobs_.begin(), jobs_.end(), [&](const RenderJob& other) {
    return IsSamePicture(other, job);
  });
  if (waiting != jobs_.end()) {
    // The new job takes the old one's place in the queue. At the back, a subject that moves all the
    // time would never be rendered.
    MergeTickets(*waiting, &job);
    job.entry = waiting->entry;
    job.submitted = waiting->submitted;  // the picture waits since then, whatever its pose
    job.was_held = waiting->was_held;
    *waiting = std::move(job);
    changed_.notify_one();  // it may take a draft now
    return PutResult::kReplaced;
  }
  if (job.tickets.empty()) return PutResult::kNotWanted;
  if (!HasRoomFor(job)) return PutResult::kFull;
  job.entry = order_.Enter(job.tickets.front().host, job.tickets.front().viewer);
  jobs_.push_back(std::move(job));
  changed_.notify_one();
  return PutResult::kQueued;
}

// The rule of FairShare. A job with several viewers counts to the host of the first one.
bool RenderMailbox::HasRoomFor(const RenderJob& job) const {
  const std::uint64_t host = job.tickets.front().host;
  const auto held = static_cast<std::size_t>(std::ranges::count_if(
      jobs_, [host](const RenderJob& other) { return other.tickets.front().host == host; }));
  return jobs_.size() < capacity_ && held < capacity_ - jobs_.size();
}

// The fairest job among the stills, or among the others. First each host chooses among its viewers,
// then the hosts are compared. A job for several viewers comes when the first of them would.
RenderMailbox::Jobs::iterator RenderMailbox::Next(bool still, bool drafts, Time now) {
  struct Choice {
    Jobs::iterator job;
    double tag = 0.0;
    double work = 0.0;
  };
  std::unordered_map<std::uint64_t, Choice> choices;  // by host
  for (auto job = jobs_.begin(); job != jobs_.end(); ++job) {
    if (job->IsStill() != still || (drafts && !job->TakesDraft()) || ReadyAt(*job) > now) continue;
    const double work = job->Work();
    for (const PictureTicket& ticket : job->tickets) {
      const double tag = order_.ViewerTag(ticket.host, ticket.viewer, job->entry, work);
      const auto [choice, is_first] = choices.try_emplace(ticket.host, Choice{job, tag, work});
      if (!is_first && tag < choice->second.tag) choice->second = {job, tag, work};
    }
  }
  auto next = jobs_.end();
  double least = 0.0;
  for (const auto& [host, choice] : choices) {
    const double tag = order_.HostTag(host, choice.job->entry, choice.work);
    // Between equals, the job that came first.
    if (next != jobs_.end() && (tag > least || (tag == least && choice.job > next))) continue;
    next = choice.job;
    least = tag;
  }
  return next;
}

// The hosts with waiting jobs, and the viewers of one host.
std::pair<std::size_t, std::size_t> RenderMailbox::CountWaiting(std::uint64_t host) const {
  std::unordered_set<std::uint64_t> hosts;
  std::unordered_set<std::uint64_t> viewers;
  for (const RenderJob& job : jobs_) {
    for (const PictureTicket& ticket : job.tickets) {
      hosts.insert(ticket.host);
      if (ticket.host == host) viewers.insert(ticket.viewer);
    }
  }
  return {hosts.size(), std::max<std::size_t>(1, viewers.size())};
}

void RenderMailbox::PutPreparation(RenderJob job, bool first) {
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  preparations_.insert(first ? preparations_.begin() : preparations_.end(), std::move(job));
  changed_.notify_one();
}

bool RenderMailbox::IsWanted(const RenderJob& job) const {
  const std::lock_guard lock(mutex_);
  if (closed_) return false;
  if (job.prepares) return !HasJob(/*drafts=*/false);
  return std::ranges::any_of(job.tickets, [this](const PictureTicket& ticket) {
    return FindTaken(ticket.subscription, ticket.still) != taken_.end();
  });
}

void RenderMailbox::SetBudget(const WorkBudget::Limits& limits, Clock clock) {
  const std::lock_guard lock(mutex_);
  budget_ = WorkBudget(limits);
  clock_ = clock;
}

// A job for several hosts is drawn as soon as one of them may be served.
Time RenderMailbox::ReadyAt(const RenderJob& job) const {
  if (clock_ == nullptr) return Time(0);
  Time ready = Time::max();
  for (const PictureTicket& ticket : job.tickets) {
    ready = std::min(ready, budget_.ReadyAt(ticket.host));
  }
  return ready;
}

// When the first job may be drawn; Time::max() if none waits.
Time RenderMailbox::ReadyAt(bool drafts) const {
  Time ready = Time::max();
  for (const RenderJob& job : jobs_) {
    if (!drafts || job.TakesDraft()) ready = std::min(ready, ReadyAt(job));
  }
  return ready;
}

void RenderMailbox::WaitForJob(std::unique_lock<std::mutex>* lock, bool drafts) {
  while (!closed_ && !woken_ && (drafts || preparations_.empty())) {
    const Time ready = ReadyAt(drafts);
    const Time now = Now();
    if (ready <= now) return;
    MarkHeld(now);
    if (ready == Time::max()) {
      changed_.wait(*lock);
    } else {
      changed_.wait_for(*lock, ready - now);
    }
  }
}

void RenderMailbox::MarkHeld(Time now) {
  for (RenderJob& job : jobs_) job.was_held |= ReadyAt(job) > now;
}

std::optional<RenderJob> RenderMailbox::Take(bool wait, bool drafts) {
  std::unique_lock lock(mutex_);
  if (wait) WaitForJob(&lock, drafts);
  if (closed_ || std::exchange(woken_, false)) return std::nullopt;
  const Time now = Now();
  MarkHeld(now);
  if (ReadyAt(drafts) > now) {
    if (!wait || drafts || preparations_.empty()) return std::nullopt;
    RenderJob job = std::move(preparations_.front());
    preparations_.pop_front();
    return job;
  }
  // A still takes longer (more samples), and nothing moves in it, so it can wait, but not for ever:
  // `passed_over_` counts how often stills were passed.
  const auto still = Next(/*still=*/true, drafts, now);
  auto next = Next(/*still=*/false, drafts, now);
  if (next == jobs_.end() || (still != jobs_.end() && passed_over_ >= kMaxPassedOver)) next = still;
  passed_over_ = still == jobs_.end() || next == still ? 0 : passed_over_ + 1;
  const auto [hosts, viewers] = CountWaiting(next->tickets.front().host);
  RenderJob job = std::move(*next);
  jobs_.erase(next);
  // Each viewer pays its part.
  const double work = job.Work() / static_cast<double>(job.tickets.size());
  for (const PictureTicket& ticket : job.tickets) {
    order_.Serve(ticket.host, ticket.viewer, job.entry, work, hosts, viewers);
    if (clock_ != nullptr) budget_.Charge(ticket.host, work, now);
    taken_.emplace(ticket.subscription, ticket.still);
  }
  return job;
}

void RenderMailbox::Wake() {
  const std::lock_guard lock(mutex_);
  woken_ = true;
  changed_.notify_all();
}

std::size_t RenderMailbox::Complete(RenderJob* job) {
  const std::lock_guard lock(mutex_);
  return std::erase_if(job->tickets, [this](const PictureTicket& ticket) {
    const auto taken = FindTaken(ticket.subscription, ticket.still);
    if (taken == taken_.end()) return true;  // withdrawn
    taken_.erase(taken);
    return false;
  });
}

std::size_t RenderMailbox::Withdraw(std::uint64_t subscription) {
  const std::lock_guard lock(mutex_);
  const std::size_t begun = taken_.erase(subscription);
  const std::size_t waiting = std::erase_if(jobs_, [subscription](RenderJob& job) {
    return std::erase_if(job.tickets,
                         [subscription](const PictureTicket& ticket) {
                           return ticket.subscription == subscription;
                         }) > 0 &&
           job.tickets.empty();
  });
  return begun + waiting;
}

bool RenderMailbox::WithdrawStill(std::uint64_t subscription) {
  const std::lock_guard lock(mutex_);
  const auto is_still_of = [subscription](const PictureTicket& ticket) {
    return ticket.still && ticket.subscription == subscription;
  };
  for (auto job = jobs_.begin(); job != jobs_.end(); ++job) {
    // A subscription has at most one waiting ticket, so the search ends with the first.
    if (std::erase_if(job->tickets, is_still_of) == 0) continue;
    if (job->tickets.empty()) jobs_.erase(job);
    return true;
  }
  const auto taken = FindTaken(subscription, /*still=*/true);
  if (taken == taken_.end()) return false;
  taken_.erase(taken);
  return true;
}

RenderMailbox::Taken::const_iterator RenderMailbox::FindTaken(std::uint64_t subscription,
                                                              bool still) const {
  const auto [begin, end] = taken_.equal_range(subscription);
  const auto found =
      std::find_if(begin, end, [still](const auto& entry) { return entry.second == still; });
  return found == end ? taken_.end() : found;
}

std::vector<RenderJob> RenderMailbox::TakeWaiting() {
  const std::lock_guard lock(mutex_);
  return TakeLocked();
}

std::vector<RenderJob> RenderMailbox::TakeLocked() {
  std::vector<RenderJob> waiting(std::make_move_iterator(jobs_.begin()),
                                 std::make_move_iterator(jobs_.end()));
  jobs_.clear();
  return waiting;
}

std::vector<RenderJob> RenderMailbox::CloseAndTake() {
  const std::lock_guard lock(mutex_);
  std::vector<RenderJob> waiting = TakeLocked();
  CloseLocked();
  return waiting;
}

void RenderMailbox::Close() {
  const std::lock_guard lock(mutex_);
  CloseLocked();
}

void RenderMailbox::CloseLocked() {
  closed_ = true;
  jobs_.clear();
  preparations_.clear();
  // Take() returns without a job, and the render thread ends.
  changed_.notify_all();
}

bool RenderMailbox::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace furrow::server
