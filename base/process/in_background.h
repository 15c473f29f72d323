// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>

#include <sys/resource.h>

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

// The same with a lower priority: `niceness` of setpriority(2), 19 is the lowest. Threads that the
// task starts inherit it. A task that runs at once has the priority of the caller, because a thread
// cannot take niceness back.
template <class Task>
[[nodiscard]] std::future<std::invoke_result_t<Task&>> InBackground(int niceness, Task task) {
  return InBackground(
      [niceness, task = std::move(task), caller = std::this_thread::get_id()]() mutable {
        if (std::this_thread::get_id() != caller) (void)setpriority(PRIO_PROCESS, 0, niceness);
        return task();
      });
}

}  // namespace furrow
