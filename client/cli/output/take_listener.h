// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/cpp/subscriber.h"
#include "recording/take_folder.h"

namespace furrow::cli {

// Writes what a daemon sends of some subjects to a take: skeletons, poses, names, weights, each as
// its payload came.
//
// The file begins with the daemon's first answer, so that none is left where there was nothing to
// record, and is on its way to the disk about twice a second.
class TakeListener {
 public:
  // `wall_offset_us`: system clock less the clock of `now_us`.
  TakeListener(recording::TakeFolderOptions options, std::int64_t wall_offset_us)
      : options_(std::move(options)), wall_offset_us_(wall_offset_us) {}

  // Subscribes to poses and weights of `subject`.
  void Ask(client::Subscriber& subscriber, const std::string& subject, bool wait);
  // To those of everybody, whoever is there and whoever comes.
  void AskForAll(client::Subscriber& subscriber);

  // Errors: TakeFolder's.
  [[nodiscard]] Status OnEvent(const client::Event& event, client::Subscriber& subscriber,
                               std::int64_t now_us);
  // Hands what waits to the operating system when it is time. Call it oftener than twice a second.
  [[nodiscard]] Status Flush(std::int64_t now_us);
  // Completes the file; fine where none was begun.
  [[nodiscard]] Status Close();

  [[nodiscard]] std::uint64_t num_poses() const { return num_poses_; }
  [[nodiscard]] std::uint64_t num_weights() const { return num_weights_; }
  // Frames that the daemon left out because we, or the network, were too slow.
  [[nodiscard]] std::uint64_t num_dropped() const;
  // After AskForAll(): how many subjects the daemon has now; none before it has said so.
  [[nodiscard]] std::optional<std::uint32_t> num_present() const { return num_present_; }
  // Those it has recorded something of: "ada, bob".
  [[nodiscard]] std::string SubjectNames() const;
  [[nodiscard]] const recording::TakeFolder* folder() const { return folder_.get(); }

 private:
  struct Source {
    std::string subject;
    std::uint64_t session = 0;            // of who publishes it
    std::vector<std::uint8_t> names;      // payload of the weights' last reply
    std::vector<std::uint32_t> requests;  // its poses', its weights'
  };
  [[nodiscard]] Status Begin(std::int64_t now_us);
  [[nodiscard]] Status OnReply(const client::Event& event, const client::Subscriber& subscriber,
                               std::int64_t now_us);
  [[nodiscard]] Status Write(recording::TakeKind kind, const Source& source,
                             const protocol::Header& header, std::span<const std::uint8_t> payload,
                             std::int64_t now_us);

  recording::TakeFolderOptions options_;
  std::int64_t wall_offset_us_;
  std::unique_ptr<recording::TakeFolder> folder_;
  std::vector<Source> sources_;
  std::set<std::string> asked_;
  std::optional<std::uint32_t> num_present_;
  std::map<std::uint16_t, std::size_t> source_of_;  // by subscription
  std::map<std::uint16_t, std::uint64_t> dropped_;  // by subscription
  std::int64_t flushed_us_ = 0;
  std::uint64_t num_poses_ = 0;
  std::uint64_t num_weights_ = 0;
};

}  // namespace furrow::cli
