// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::net {

// Raises this process's limit of open files and sockets to the system's hard limit. Shells set it
// to 1,024 by default, which is too low for a load test with many subjects or clients.
void RaiseDescriptorLimit();

}  // namespace furrow::net
