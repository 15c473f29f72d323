// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/text.h"

namespace furrow::report {

using furrow::Counted;

}  // namespace furrow::report
