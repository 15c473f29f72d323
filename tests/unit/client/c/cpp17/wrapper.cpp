// SPDX-License-Identifier: Apache-2.0
// Uses every function of the C++17 wrapper without a daemon. Compiled as C++17.
#include <utility>

#include "client/c/include/furrow/furrow.hpp"

static_assert(__cplusplus == 201703L, "the wrapper must not need more than C++17");

namespace {

int failures = 0;

void Expect(bool condition) { failures += condition ? 0 : 1; }

// Runs `call` and returns the status of the furrow::Error that it throws.
template <class Call>
furrow_status Thrown(Call&& call) {
  try {
    call();
  } catch (const furrow::Error& error) {
    Expect(error.what()[0] != '\0');
    return error.status();
  }
  return FURROW_OK;
}

void Publish(furrow::Connection& connection) {
  furrow::Skeleton skeleton;
  skeleton.subject = "cleo";
  skeleton.joints.resize(1);
  skeleton.joints[0].name = "head";
  skeleton.blend_shapes = {"jawOpen"};
  const std::uint32_t stream = connection.Offer(skeleton);
  Expect(!connection.Accepted(stream));
  furrow::Pose pose;
  pose.rotations = {0, 0, 0, 1};
  pose.blend_shapes = {0.5f};
  Expect(!connection.Send(stream, pose));
  pose.rotations.pop_back();
  Expect(Thrown([&] { connection.Send(stream, pose); }) == FURROW_INVALID_ARGUMENT);
  connection.Withdraw(stream);
  Expect(Thrown([&] { (void)connection.Accepted(stream); }) == FURROW_REJECTED);
  skeleton.joints[0].parent = 5;
  Expect(Thrown([&] { connection.Offer(skeleton); }) == FURROW_INVALID_ARGUMENT);
}

}  // namespace

// Returns the number of failures.
int FurrowWrapper() {
  Expect(Thrown([] { furrow::Connection("http://a"); }) == FURROW_INVALID_ADDRESS);
  furrow::Connection opened("furrow://127.0.0.1:9?subject=ada", "wrapper test");
  furrow::Connection connection = std::move(opened);
  furrow::Callbacks callbacks;
  callbacks.on_state = [](furrow_state) {};
  connection.SetCallbacks(std::move(callbacks));
  Expect(!connection.Poll());
  furrow::Weights weights;
  Expect(!connection.Latest("ada", weights));
  Expect(!connection.Latest(weights));
  Expect(connection.Names("ada").empty());
  connection.Subscribe("bob", "brow_*", 60.0f);
  Expect(connection.Info().subjects == 2);
  Expect(Thrown([&] { connection.Subscribe("bob"); }) == FURROW_INVALID_ARGUMENT);
  connection.Unsubscribe("bob");
  Expect(Thrown([&] { connection.Latest("bob", weights); }) == FURROW_NOT_FOUND);
  Publish(connection);
  return failures;
}
