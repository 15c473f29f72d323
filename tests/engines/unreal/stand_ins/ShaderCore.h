// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"

void AddShaderSourceDirectoryMapping(const FString& virtual_folder, const FString& folder);
