// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"

class FPaths {
 public:
  static FString Combine(const FString& folder, const FString& name) {
    return FString::Printf("%s/%s", *folder, *name);
  }
};
