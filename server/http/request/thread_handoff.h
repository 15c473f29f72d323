// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "server/core/time.h"

namespace furrow::server {

class Hub;

// Posts a task from the web thread to the hub's thread (shard 0). Tasks run once, in the order of
// the calls, or never if the daemon stops first.
using PostToHub = std::function<void(std::function<void(Hub& hub, Time now)>)>;

// Posts a task to the web thread. Tasks never run if the web server has stopped. The function may
// outlive the web server.
using PostToWeb = std::function<void(std::function<void()>)>;

}  // namespace furrow::server
