// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recorder.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/status.h"
#include "protocol/framing/envelope.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"
#include "rig/rig_file.h"
#include "server/core/within_memory.h"
#include "server/net/clock.h"
#include "server/pipeline/wire_adapter.h"

namespace furrow::server {
namespace {

using recording::TakeKind;

// Their sum stays well below the second that a killed daemon may lose.
constexpr auto kWait = std::chrono::milliseconds(200);
constexpr Time kFlushInterval = std::chrono::milliseconds(400);

// Reused memory of one network thread.
struct Scratch {
  protocol::Encoder encoder;
  std::vector<std::uint8_t> buffer;
  protocol::PoseFrame pose;
  protocol::WeightFrame weights;
};

// Shards record at once. Memory per thread needs no lock and is reused for each message.
Scratch& ScratchOfThread() {
  thread_local Scratch scratch;
  return scratch;
}

// An attempt on a full disk would take the space that others free.
bool HasRoom(const RecorderOptions& options) {
  std::filesystem::path folder = std::filesystem::absolute(options.folder.folder);
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  const auto space = std::filesystem::space(folder, error);
  // If the amount of space is unknown, the attempt tells what is wrong.
  return error || space.available >= options.least_space;
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::Start(RecorderOptions options, Time now,
                                                  Metrics* metrics) {
  const auto began = static_cast<std::uint64_t>((now + options.wall_offset).count());
  auto folder = recording::TakeFolder::Open(options.folder, began);
  if (folder.ok()) {
    spdlog::info("recording to {}", (*folder)->path().string());
  } else if (HasRoom(options)) {
    return folder.status();
  } else {
    // A full disk must not keep the weights away, as it would not later.
    folder = recording::TakeFolder::Failed(options.folder, folder.status());
  }
  return std::unique_ptr<Recorder>(new Recorder(std::move(options), *std::move(folder), metrics));
}

Recorder::Recorder(RecorderOptions options, std::unique_ptr<recording::TakeFolder> folder,
                   Metrics* metrics)
    : options_(std::move(options)),
      metrics_(metrics),
      folder_(std::move(folder)),
      queue_(options_.queue_bytes),
      paused_(!folder_->failure().ok()),
      // The last member: the thread may use everything above at once.
      thread_([this] { Write(); }) {}

Recorder::~Recorder() {
  // Write() takes what is left in the queue, completes the file and returns.
  queue_.Stop();
  thread_.join();
}

// Nanoseconds since 1970. The offset is constant, so recorded times never go back.
std::uint64_t Recorder::LogTime(Time now) const {
  return static_cast<std::uint64_t>((now + options_.wall_offset).count());
}

void Recorder::PushEntry(const RecordingBatch::Entry& entry, std::string_view subject,
                         std::span<const std::uint8_t> payload) {
  // What a later file begins with is needed during a pause, too. A message that is not needed is
  // dropped here, which saves copying; the recording thread drops those that are already queued.
  if ((is_paused() && !entry.is_declaration()) || !queue_.Push(entry, subject, payload)) {
    metrics_->Add(Counter::kRecordingDropped);
  }
}

// Queues a message of the subject, stamped with its publisher's session, sequence and capture time.
void Recorder::Push(TakeKind kind, const Subject& subject, std::span<const std::uint8_t> payload,
                    Time now) {
  RecordingBatch::Entry entry;
  entry.kind = kind;
  entry.stamp.session = subject.owner.session;
  entry.stamp.log_time_ns = LogTime(now);
  if (subject.pipeline->has_pose()) {
    entry.stamp.sequence = subject.pipeline->sequence();
    entry.stamp.capture_time_us = subject.pipeline->capture_time_us();
  }
  PushEntry(entry, subject.name, payload);
}

template <class Message>
void Recorder::PushEncoded(TakeKind kind, const Subject& subject, const Message& message,
                           Time now) {
  // The envelope is not recorded, but the encoder writes one.
  Scratch& scratch = ScratchOfThread();
  scratch.encoder.Encode({.session = subject.owner.session}, message, scratch.buffer);
  Push(kind, subject, std::span(scratch.buffer).subspan(protocol::kEnvelopeBytes), now);
}

void Recorder::OnOffer(const Subject& subject, const protocol::SkeletonOffer& offer, Time now) {
  PushEncoded(TakeKind::kSkeleton, subject, offer, now);
  DeclareNames(subject, now);
}

void Recorder::DeclareNames(const Subject& subject, Time now) {
  names_hashes_.erase(subject.id);
  const auto names = subject.pipeline->stream().binding->weight_names();
  // A message cannot list that many names. The poses alone are recorded; solving them with the rig
  // gives the weights.
  if (names.empty() || names.size() > static_cast<std::size_t>(protocol::kMaxWeights)) return;
  protocol::SubscribeReply declared;
  declared.subject = subject.name;
  declared.names.assign(names.begin(), names.end());
  // OnWeights() reads the map on several threads. This is safe, because it changes only here and in
  // OnSubjectGone(), under the hub's exclusive lock.
  names_hashes_[subject.id] = protocol::NamesHash(names);
  PushEncoded(TakeKind::kNames, subject, declared, now);
}

void Recorder::OnRig(const wrinkle::Rig& rig, const SubjectRegistry& subjects, Time now) {
  const bool has_memory = WithinMemory(metrics_, [&] {
    const std::string json = rig::RigToJson(rig);
    RecordingBatch::Entry entry;
    entry.event = RecordingBatch::Event::kRig;
    PushEntry(entry, {},
              std::span(reinterpret_cast<const std::uint8_t*>(json.data()), json.size()));
    for (const auto& subject : subjects.all()) DeclareNames(*subject, now);
  });
  if (!has_memory) metrics_->Add(Counter::kRecordingDropped);
}

void Recorder::OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time now) {
  // The payload as it arrived: the recording has the bytes of the sender, not a copy with rounding.
  if (!payload.empty()) return Push(TakeKind::kPose, subject, payload, now);
  // Record a whole pose, so that playback can start anywhere.
  protocol::PoseFrame& pose = ScratchOfThread().pose;
  ToWholePose(subject.pipeline->pose(), subject.pipeline->stream(), &pose);
  pose.skeleton_hash = subject.skeleton_hash;
  pose.timecode = subject.timecode;
  PushEncoded(TakeKind::kPose, subject, pose, now);
}

void Recorder::OnWeights(const Subject& subject, std::int64_t age_us, Time now) {
  const auto hash = names_hashes_.find(subject.id);
  if (hash == names_hashes_.end()) return;
  const auto values = subject.pipeline->wrinkle_weights();
  protocol::WeightFrame& weights = ScratchOfThread().weights;
  weights.names_hash = hash->second;
  weights.age_us = age_us;
  weights.timecode = subject.timecode;
  weights.values.assign(values.begin(), values.end());
  PushEncoded(TakeKind::kWeights, subject, weights, now);
}

void Recorder::OnSubjectGone(const Subject& subject) {
  names_hashes_.erase(subject.id);
  RecordingBatch::Entry entry;
  entry.event = RecordingBatch::Event::kGone;
  PushEntry(entry, subject.name, {});
}

void Recorder::OnDatagram(const recording::DatagramSender& sender,
                          std::span<const std::uint8_t> bytes, Time now) {
  if (!options_.datagrams) return;
  RecordingBatch::Entry entry;
  entry.event = RecordingBatch::Event::kDatagram;
  entry.stamp.log_time_ns = LogTime(now);
  // The field of the subject's name carries the address, so that the queue needs one kind of entry.
  PushEntry(entry, {reinterpret_cast<const char*>(sender.data()), sender.size()}, bytes);
}

Status Recorder::WriteEntry(const RecordingBatch::Entry& entry, std::string_view subject,
                            std::span<const std::uint8_t> payload) {
  switch (entry.event) {
    case RecordingBatch::Event::kGone: folder_->Forget(subject); break;
    case RecordingBatch::Event::kRig:
      folder_->SetRig({reinterpret_cast<const char*>(payload.data()), payload.size()});
      break;
    case RecordingBatch::Event::kDatagram: {
      recording::DatagramSender sender{};
      std::copy_n(subject.begin(), sender.size(), sender.begin());
      return folder_->WriteDatagram(sender, entry.stamp.log_time_ns, payload);
    }
    case RecordingBatch::Event::kMessage:
      return folder_->Write(entry.kind, subject, entry.stamp, payload);
  }
  return {};
}

// Without memory, the present file may lack a declaration, so the recording goes on in another.
template <class Work>
Status Recorder::Guarded(const Work& work) {
  Status status = OrOutOfMemory(metrics_, "recording", work);
  if (!status.ok()) folder_->Fail(status);
  return status;
}

// Writes the events in order. Returns the first error. The events after it are only passed on, so
// that the folder knows the subjects when the recording goes on.
Status Recorder::WriteBatch(const RecordingBatch& batch) {
  Status first;
  std::uint64_t lost = 0;
  const int file = folder_->num_files();
  const std::uint64_t before = folder_->num_messages();
  batch.ForEach([&](const RecordingBatch::Entry& entry, std::string_view subject,
                    std::span<const std::uint8_t> payload) {
    Status status = Guarded([&] { return WriteEntry(entry, subject, payload); });
    if (status.ok()) return true;
    ++lost;
    if (first.ok()) first = std::move(status);
    return true;
  });
  metrics_->Add(Counter::kRecordingDropped, lost);
  metrics_->Add(Counter::kRecordingMessages, folder_->num_messages() - before);
  // TakeFolder begins a new file by itself when the present one reaches its size or age.
  if (first.ok() && folder_->num_files() != file)
    spdlog::info("recording continues in {}", folder_->path().string());
  return first;
}

void Recorder::ReportDropped(std::string_view why) {
  const std::uint64_t dropped = metrics_->Get(Counter::kRecordingDropped);
  if (dropped == reported_dropped_) return;
  spdlog::warn("{}: {} messages are missing from the recording", why, dropped - reported_dropped_);
  reported_dropped_ = dropped;
}

void Recorder::Pause(const Status& status) {
  paused_ = true;
  next_try_ = ReadClock() + options_.retry;
  metrics_->Add(Counter::kRecordingFailures);
  spdlog::error("recording paused: {}; it goes on as soon as a new file can be written",
                status.ToString());
}

Status Recorder::LeaveLostFile(Time now) {
  const std::string lost = folder_->path().string();
  const Result<bool> left = folder_->LeaveLostFile(LogTime(now));
  FURROW_RETURN_IF_ERROR(left);
  if (*left) {
    spdlog::error("the recording {} was removed or renamed; it goes on in {}", lost,
                  folder_->path().string());
  }
  return {};
}

void Recorder::TryToGoOn(Time now) {
  if (now < next_try_) return;
  next_try_ = now + options_.retry;
  const auto resume = [&] { return folder_->Resume(LogTime(now)); };
  if (!HasRoom(options_) || !Guarded(resume).ok()) return;
  paused_ = false;
  ReportDropped("while the recording was paused");
  spdlog::info("recording again, in {}", folder_->path().string());
}

void Recorder::Write() {
  RecordingBatch batch;
  Time flushed = ReadClock();
  bool goes_on = true;
  if (paused_) Pause(folder_->failure());
  while (goes_on) {
    // The queue is emptied during a pause, too, or it would hold its bytes for as long.
    goes_on = queue_.Take(&batch, kWait);
    Status status = WriteBatch(batch);
    const Time now = ReadClock();
    if (paused_) {
      if (goes_on) TryToGoOn(now);
      continue;
    }
    // Flushing ends an MCAP chunk. Each batch as a chunk would compress badly; none for long would
    // lose more when the daemon is killed.
    if (status.ok() && now - flushed >= kFlushInterval) {
      status = Guarded([this] { return folder_->Flush(); });
      if (status.ok()) {
        status = Guarded([&] { return LeaveLostFile(now); });
      }
      flushed = now;
      ReportDropped("the disk is too slow");
    }
    if (status.ok() && !goes_on) {
      status = Guarded([this] { return folder_->Close(); });
    }
    if (!status.ok()) Pause(status);
  }
  if (paused_) (void)folder_->Close();  // its error is known
  ReportDropped(paused_ ? "the recording was paused" : "the disk is too slow");
  const bool is_discarded = discards_ && folder_->RemoveIfEmpty();
  if (!is_discarded && !paused_) {
    spdlog::info("finished recording to {}", folder_->path().string());
  }
}

}  // namespace furrow::server
