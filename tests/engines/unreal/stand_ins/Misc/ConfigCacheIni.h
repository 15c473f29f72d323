// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"

// A configuration file without the section [Furrow].
struct FConfigCacheIni {
  bool GetString(const TCHAR*, const TCHAR*, FString&, const FString&) const { return false; }
};
inline FConfigCacheIni config_of_the_engine;
inline FConfigCacheIni* GConfig = &config_of_the_engine;
inline FString GEngineIni;
