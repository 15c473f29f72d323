// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::load {

// Lets this process open as many files and sockets as the system's hard limit allows: shells give
// 1,024 by default, and a load of many subjects or clients needs more.
void RaiseDescriptorLimit();

}  // namespace furrow::load
