// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "server/core/time.h"

namespace furrow::server {

class Hub;

// The way from the web's thread to the thread that the hub lives on: runs there, soon, once, in the
// order of the calls; or never, where the daemon ends first.
using PostToHub = std::function<void(std::function<void(Hub& hub, Time now)>)>;

// The way back: runs on the web's thread, or never, where the web side has ended. Safe to call and
// to keep for longer than that side lives.
using PostToWeb = std::function<void(std::function<void()>)>;

}  // namespace furrow::server
