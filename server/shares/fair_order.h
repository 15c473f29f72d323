// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace furrow::server {

// Shares the work of one server between hosts, and the part of a host between its viewers. Each
// job has a tag: the work that its viewer will have been served when the job is complete. Jobs with
// the smallest tag come next, so viewers are served equally, and a small job does not wait for all
// large ones that came before it. Somebody who asked for nothing does not save up: tags begin at
// the present, which moves on by an equal share of each job, so no job is passed for ever.
//
// The rule is weighted fair queueing (Demers, Keshav and Shenker 1989) with equal weights, in two
// levels. Not thread-safe.
class FairOrder {
 public:
  // Where the tags of a job begin at the earliest, on both levels: fixed when it begins to wait.
  struct Entry {
    double host = 0.0;
    double viewer = 0.0;
  };
  [[nodiscard]] Entry Enter(std::uint64_t host, std::uint64_t viewer) const {
    const auto found = hosts_.find(host);
    if (found == hosts_.end()) return {now_, now_};
    const auto known = found->second.viewers.find(viewer);
    const double now = found->second.now;
    return {std::max(now_, found->second.served),
            known == found->second.viewers.end() ? now : std::max(now, known->second)};
  }
  // The tags of a job that began to wait at `entry`: among all hosts, and among the viewers of its
  // host. `work` > 0, in any unit.
  [[nodiscard]] double HostTag(std::uint64_t host, const Entry& entry, double work) const {
    const auto found = hosts_.find(host);
    return std::max(entry.host, found == hosts_.end() ? 0.0 : found->second.served) + work;
  }
  [[nodiscard]] double ViewerTag(std::uint64_t host, std::uint64_t viewer, const Entry& entry,
                                 double work) const {
    double served = 0.0;
    if (const auto found = hosts_.find(host); found != hosts_.end()) {
      const auto known = found->second.viewers.find(viewer);
      if (known != found->second.viewers.end()) served = known->second;
    }
    return std::max(entry.viewer, served) + work;
  }
  // The job is served now. `hosts`, `viewers`: how many hosts, and viewers of its host, had jobs,
  // this one included.
  void Serve(std::uint64_t host, std::uint64_t viewer, const Entry& entry, double work,
             std::size_t hosts = 1, std::size_t viewers = 1) {
    const double host_tag = HostTag(host, entry, work);
    const double viewer_tag = ViewerTag(host, viewer, entry, work);
    Host& served = hosts_.try_emplace(host, Host{.now = now_}).first->second;
    now_ += work / static_cast<double>(hosts);
    served.served = host_tag;
    served.now += work / static_cast<double>(viewers);
    served.viewers[viewer] = viewer_tag;
    // Far more than can have jobs at a time. Those whose tags have passed need no memory, because
    // they would begin at the present, too.
    if (served.viewers.size() > kMaxKeys) {
      std::erase_if(served.viewers, [&](const auto& each) { return each.second <= served.now; });
    }
    if (served.viewers.size() > kMaxKeys) served.viewers.clear();
    if (hosts_.size() <= kMaxKeys) return;
    std::erase_if(hosts_, [this](const auto& each) { return each.second.served <= now_; });
    if (hosts_.size() > kMaxKeys) hosts_.clear();
  }
  [[nodiscard]] std::size_t num_hosts() const { return hosts_.size(); }

 private:
  static constexpr std::size_t kMaxKeys = 1024;
  struct Host {
    double served = 0.0;                                // the tag of its last job
    double now = 0.0;                                   // of its viewers
    std::unordered_map<std::uint64_t, double> viewers;  // the tags of their last jobs
  };
  double now_ = 0.0;
  std::unordered_map<std::uint64_t, Host> hosts_;
};

}  // namespace furrow::server
