// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <system_error>
#include <type_traits>
#include <utility>

namespace furrow {

// Runs `task` on a thread of its own, or at once if no further thread may start. Destroying the
// future waits for the task.
template <class Task>
[[nodiscard]] std::future<std::invoke_result_t<Task&>> InBackground(Task task) {
  try {
    return std::async(std::launch::async, task);
  } catch (const std::system_error&) {
    std::packaged_task<std::invoke_result_t<Task&>()> here(std::move(task));
    here();
    return here.get_future();
  }
}

}  // namespace furrow
