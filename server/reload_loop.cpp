// SPDX-License-Identifier: Apache-2.0
#include "server/reload_loop.h"

#include <csignal>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#include <asio/post.hpp>
#include <spdlog/spdlog.h>

#include "server/core/within_memory.h"
#include "server/machine/terminal.h"
#include "server/net/await_tuple.h"
#include "server/net/critical_task.h"

namespace furrow::server {

ReloadLoop::ReloadLoop(Parts parts)
    : parts_(std::move(parts)), hangups_(*parts_.io), has_terminal_(HasTerminal()) {}

void ReloadLoop::Start() {
  hangups_.add(SIGHUP);
  StartCriticalTask(*parts_.io, Run());
}

void ReloadLoop::LookAtTerminal() { has_terminal_ = HasTerminal(); }

asio::awaitable<void> ReloadLoop::Run() {
  while (true) {
    const auto [error, signal] = co_await hangups_.async_wait(kAwaitTuple);
    if (error) co_return;
    if (parts_.is_draining()) continue;
    // The terminal has just closed, and with it the program that the user had started in it.
    if (has_terminal_ && !HasTerminal()) {
      parts_.shut_down();
    } else {
      Begin();
    }
  }
}

void ReloadLoop::Begin() {
  reads_again_ = is_reading_;
  if (std::exchange(is_reading_, true)) return;
  if (parts_.manager != nullptr) parts_.manager->Reloading();
  try {
    Read();
  } catch (const std::exception& fault) {  // no memory, or no thread
    End(Status(StatusCode::kLimit, fault.what()));
  }
}

void ReloadLoop::Read() {
  // Shared, because a handler must be copyable.
  auto reload = std::make_shared<Result<Reload>>(Status(StatusCode::kLimit, "out of memory"));
  reader_ = std::jthread([this, reload, request = parts_.request()] {
    try {
      *reload = PrepareReload(request);
    } catch (const std::bad_alloc&) {
      parts_.metrics->Add(Counter::kAllocationsFailed);
    } catch (const std::exception& fault) {
      *reload = Status(StatusCode::kInternal, fault.what());
    }
    const auto post = [&] { asio::post(*parts_.io, [this, reload] { End(std::move(*reload)); }); };
    // Without an end, no other reload would begin.
    while (!WithinMemory(parts_.metrics, post)) std::this_thread::yield();
  });
}

void ReloadLoop::End(Result<Reload> reload) {
  is_reading_ = false;
  if (parts_.is_draining()) return;
  const Status status = reload.ok() ? parts_.take_over(&*reload) : reload.status();
  is_refused_ = !status.ok();
  if (is_refused_) spdlog::error("the configuration stays as it was: {}", status.ToString());
  if (parts_.manager != nullptr) {
    parts_.manager->Ready(status.ok() ? "the configuration was read again"
                                      : "the configuration stays as it was; see the log");
  }
  if (reads_again_) Begin();
}

}  // namespace furrow::server
