// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/node_link.h"

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <gtest/gtest.h>

#include "protocol/codec/codec.h"

namespace furrow::server {
namespace {

using asio::ip::udp;
using std::chrono::milliseconds;

class NodeLinkTest : public ::testing::Test {
 protected:
  // Returns when nothing is left to do: the link has ended altogether.
  Status Connect(Time patience) {
    auto link = std::make_shared<NodeLink>(io, options);
    Status status;
    asio::co_spawn(
        io,
        [&]() -> asio::awaitable<void> {
          status = co_await link->Connect(patience);
          failed = link->failed();
          link->Close();
          link->Send(std::vector<std::uint8_t>(40));  // a closed link sends nothing
          link.reset();
        },
        asio::detached);
    io.run();
    return status;
  }

  asio::io_context io;
  NodeLink::Options options{.node = {"b", "node-b", 7400, 7401, 0},
                            .session = 7,
                            .token = {},
                            .on_answer = [](std::uint32_t, bool, const std::string&) {}};
  bool failed = false;
};

// The deadline alone ends the wait; the system answers when nobody listens any more.
TEST_F(NodeLinkTest, ALookUpWithoutAnAnswerIsLeftAlone) {
  NodeLink::Options::Found late;
  options.look_up = [&late](const NodeAddress& node, NodeLink::Options::Found found) {
    EXPECT_EQ(node.host, "node-b");
    late = std::move(found);
  };
  const Status status = Connect(milliseconds(1));
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_EQ(status.what(), "the node 'b' cannot be reached: Connection timed out");
  ASSERT_TRUE(late);
  late({}, udp::resolver::results_type::create(udp::endpoint(udp::v4(), 7401), "node-b", ""));
}

TEST_F(NodeLinkTest, AHostThatIsNotFoundIsNamedAtOnce) {
  options.look_up = [](const NodeAddress&, const NodeLink::Options::Found& found) {
    found(asio::error::host_not_found, {});
  };
  const Status status = Connect(std::chrono::hours(1));
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_TRUE(status.what().starts_with("the node 'b' cannot be reached: Host not found"))
      << status.what();
}

TEST_F(NodeLinkTest, ANodeThatDoesNotAnswerIsGivenUpAndItsLinkEnds) {
  const udp::socket silent(io, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  options.node.host = "127.0.0.1";
  options.node.udp = silent.local_endpoint().port();
  const Status status = Connect(milliseconds(5));
  EXPECT_EQ(status.what(), "the node 'b' does not answer");
  EXPECT_FALSE(failed);
}

TEST_F(NodeLinkTest, ANodeThatRefusesThisOneHasFailed) {
  udp::socket node(io, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  options.node.host = "127.0.0.1";
  options.node.udp = node.local_endpoint().port();
  std::array<std::uint8_t, 2048> hello{};
  udp::endpoint sender;
  std::vector<std::uint8_t> error;
  protocol::Encoder().Encode(
      {.session = 9}, protocol::ErrorMessage{protocol::ErrorCode::kDraining, "I leave"}, error);
  node.async_receive_from(asio::buffer(hello), sender, [&](const asio::error_code&, std::size_t) {
    node.send_to(asio::buffer(error), sender);
  });
  const Status status = Connect(std::chrono::hours(1));
  EXPECT_EQ(status.what(), "the node 'b' refuses this one: I leave");
  EXPECT_TRUE(failed);
}

}  // namespace
}  // namespace furrow::server
