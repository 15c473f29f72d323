// SPDX-License-Identifier: Apache-2.0
#include "server/shares/fair_order.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

// Somebody who always wants a job of the same work.
struct Client {
  std::uint64_t host = 0;
  std::uint64_t viewer = 0;
  double work = 1.0;
  double served = 0.0;
  FairOrder::Entry entry;
};

// Serves `count` jobs. Each client enters its next job when the last one is served.
void ServeJobs(FairOrder& order, std::vector<Client>& clients, int count) {
  for (Client& client : clients) client.entry = order.Enter(client.host, client.viewer);
  for (int i = 0; i < count; ++i) {
    Client* next = nullptr;
    for (Client& client : clients) {
      if (next == nullptr) {
        next = &client;
        continue;
      }
      const bool same = client.host == next->host;
      const double mine =
          same ? order.ViewerTag(client.host, client.viewer, client.entry, client.work)
               : order.HostTag(client.host, client.entry, client.work);
      const double other = same ? order.ViewerTag(next->host, next->viewer, next->entry, next->work)
                                : order.HostTag(next->host, next->entry, next->work);
      if (mine < other) next = &client;
    }
    std::set<std::uint64_t> hosts;
    std::size_t viewers = 0;
    for (const Client& client : clients) {
      hosts.insert(client.host);
      viewers += client.host == next->host ? 1 : 0;
    }
    order.Serve(next->host, next->viewer, next->entry, next->work, hosts.size(), viewers);
    next->served += next->work;
    next->entry = order.Enter(next->host, next->viewer);
  }
}

TEST(FairOrder, HostsGetEqualWorkWhateverTheSizeOfTheirJobs) {
  FairOrder order;
  std::vector<Client> clients = {{.host = 1, .viewer = 1, .work = 10.0},
                                 {.host = 2, .viewer = 2, .work = 1.0}};
  ServeJobs(order, clients, 1000);
  EXPECT_NEAR(clients[0].served, clients[1].served, 20.0);
}

TEST(FairOrder, ManyViewersOfAHostShareItsPart) {
  FairOrder order;
  std::vector<Client> clients = {{.host = 1, .viewer = 100}};
  for (std::uint64_t viewer = 1; viewer <= 10; ++viewer) {
    clients.push_back({.host = 2, .viewer = viewer});
  }
  ServeJobs(order, clients, 1000);
  EXPECT_NEAR(clients[0].served, 500, 10);
  for (std::size_t i = 1; i < clients.size(); ++i) EXPECT_NEAR(clients[i].served, 50, 5);
}

TEST(FairOrder, ViewersOfAHostGetEqualWork) {
  FairOrder order;
  std::vector<Client> clients = {{.host = 1, .viewer = 1, .work = 20.0},
                                 {.host = 1, .viewer = 2, .work = 1.0}};
  ServeJobs(order, clients, 1000);
  EXPECT_NEAR(clients[0].served, clients[1].served, 40.0);
}

TEST(FairOrder, ASmallJobGoesBeforeLargeOnesOfTheSameTime) {
  FairOrder order;
  const FairOrder::Entry large = order.Enter(1, 2);
  order.Serve(1, 1, order.Enter(1, 1), 100.0, 1, 2);
  const FairOrder::Entry small = order.Enter(1, 3);
  EXPECT_LT(order.ViewerTag(1, 3, small, 1.0), order.ViewerTag(1, 2, large, 100.0));
}

TEST(FairOrder, SmallJobsOfNewcomersDoNotPassALargeOneForEver) {
  FairOrder order;
  const FairOrder::Entry large = order.Enter(1, 1);
  std::uint64_t newcomer = 1;
  while (newcomer < 1000) {
    ++newcomer;
    const FairOrder::Entry small = order.Enter(1, newcomer);
    if (order.ViewerTag(1, 1, large, 50.0) <= order.ViewerTag(1, newcomer, small, 1.0)) break;
    order.Serve(1, newcomer, small, 1.0, 1, 2);
  }
  EXPECT_LT(newcomer, 150u);
}

TEST(FairOrder, NobodySavesUp) {
  FairOrder order;
  for (int i = 0; i < 100; ++i) order.Serve(1, 1, order.Enter(1, 1), 1.0);
  // A newcomer is not 99 jobs ahead.
  order.Serve(2, 2, order.Enter(2, 2), 2.0);
  EXPECT_LT(order.HostTag(1, order.Enter(1, 1), 1.0), order.HostTag(2, order.Enter(2, 2), 2.0));
}

TEST(FairOrder, HostsThatAreNotAheadNeedNoMemory) {
  FairOrder order;
  for (std::uint64_t host = 0; host < 100'000; ++host) {
    order.Serve(host, host, order.Enter(host, host), 1.0);
  }
  EXPECT_LE(order.num_hosts(), 1024u);
}

}  // namespace
}  // namespace furrow::server
