// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "server/cluster/coordinator.h"
#include "server/cluster/lease/lease_keeper.h"
#include "server/cluster/store/node_table.h"
#include "server/cluster/store/store.h"
#include "server/cluster/store/transits.h"

namespace furrow::server {

// A cluster whose nodes keep the leases of their subjects in a store. A thread of its own does all
// that may wait. The hub's thread reads a view that this thread replaces, and leaves requests for
// it; neither ever waits for the store.
class StoreCoordinator : public Coordinator {
 public:
  struct Parts {
    std::unique_ptr<Store> store;           // not null
    std::string node;                       // the name of this one
    std::uint64_t run = 0;                  // random, not 0
    int capacity = 0;                       // subjects that this node takes
    bool strict = false;                    // LeaseKeeper
    std::function<Time()> now;              // the clock of all `now` arguments
    std::function<Time()> pause;            // Pulse::TakeLongestPause()
    std::function<std::int64_t()> unix_ms;  // the system's clock
  };
  explicit StoreCoordinator(Parts parts);
  // Waits for the present call of the store, such as one attempt to connect (Store::Poll()). Then
  // gives all leases back, for at most kFarewell.
  ~StoreCoordinator() override;
  static constexpr Time kFarewell = std::chrono::seconds(2);

  [[nodiscard]] Status Start(const NodeAddress& self) override;
  [[nodiscard]] Place Ask(std::string_view subject, Time now) override;
  [[nodiscard]] Place Find(std::string_view subject, Time now) const override;
  [[nodiscard]] Place Elsewhere(std::string_view subject) const override;
  [[nodiscard]] Place Propose(std::string_view subject, Time now) const override;
  [[nodiscard]] Place Successor(std::string_view subject,
                                const std::set<std::string>& without) const override;
  [[nodiscard]] std::vector<NodeAddress> Others() const override;
  [[nodiscard]] Place Expect(std::string_view subject, Time now) override;
  void HandOver(std::string_view subject, const NodeAddress& heir) override;
  void Release(std::string_view subject) override;
  void SetDraining() override;
  [[nodiscard]] ClusterState State(Time now) const override;
  [[nodiscard]] std::string Fault(Time now) const override;

 private:
  // What the hub's thread sees.
  struct View {
    std::map<std::string, LeaseKeeper::Serving, std::less<>> own;
    std::map<std::string, Lease, std::less<>> foreign;
    std::map<std::string, Announcement> others;
    bool reachable = false;
    bool may_take = false;
    bool has_rival = false;  // NodeTable
    std::string fault;
  };
  // What the hub's thread wants.
  struct Requests {
    std::map<std::string, bool, std::less<>> wanted;  // false: to be released
    std::map<std::string, std::string> heirs;         // by subject: the nodes that get it
    bool draining = false;
  };

  void Run(const std::stop_token& stop);
  void Step(std::chrono::milliseconds wait);
  void StepWithinMemory(std::chrono::milliseconds wait);
  void LookAround();
  void TakeRequests();
  void List();
  void OnRecord(const StoreRecord& record, std::vector<LeaseEntry>* entries, Time now);
  void Publish(Time now);
  void LogChanges(const View& view);
  [[nodiscard]] bool is_draining() const;
  [[nodiscard]] std::shared_ptr<const View> view() const;
  void Request(std::string_view subject, bool wanted);
  [[nodiscard]] Place ForeignPlace(const View& view, std::string_view subject) const;
  [[nodiscard]] const Announcement* RoomElsewhere(const View& view,
                                                  const std::set<std::string>& without = {}) const;
  [[nodiscard]] bool HasRoomFor(const View& view, std::string_view subject) const;

  NodeAddress self_;  // set by Start()
  const std::uint64_t run_;
  const int capacity_;
  const std::function<Time()> now_;
  const std::function<Time()> pause_;
  const std::function<std::int64_t()> unix_ms_;

  // Used by the thread alone, except Store::Wake().
  const std::unique_ptr<Store> store_;
  LeaseKeeper leases_;
  NodeTable nodes_{{}};
  bool draining_ = false;
  Time hurries_until_{0};  // a subject moves, and its viewers wait
  bool missed_ = true;     // changes may have been missed
  Time listed_{0};
  std::uint64_t next_id_ = 1;
  struct Write {
    std::string subject;
    std::uint64_t id = 0;  // LeaseWrite::id
  };
  std::map<std::uint64_t, Write> writes_;  // of leases, by the number of the put
  std::string why_;                        // the store could not be read
  std::string logged_;

  Transits transits_;         // has a lock of its own
  mutable std::mutex mutex_;  // guards those below, for moments
  std::shared_ptr<const View> view_ = std::make_shared<const View>();
  Requests requests_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace furrow::server
