// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "CoreMinimal.h"

// Knows one plug-in, which lies where a project has its plug-ins.
class IPlugin {
 public:
  FString GetBaseDir() const { return "../../../Project/Plugins/Furrow"; }
};

class IPluginManager {
 public:
  static IPluginManager& Get() {
    static IPluginManager manager;
    return manager;
  }
  TSharedPtr<IPlugin> FindPlugin(const FString& name) const {
    if (std::string(*name) != "Furrow") throw std::runtime_error("no such plug-in");
    return MakeShared<IPlugin>();
  }
};
