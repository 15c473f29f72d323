// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "LiveLinkTypes.h"

struct ULiveLinkBasicRole {
  static UClass* StaticClass() {
    static UClass role;
    return &role;
  }
};
