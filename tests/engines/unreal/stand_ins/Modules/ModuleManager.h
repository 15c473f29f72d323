// SPDX-License-Identifier: Apache-2.0
#pragma once

class IModuleInterface {
 public:
  virtual ~IModuleInterface() = default;
  virtual void StartupModule() {}
};

class FDefaultModuleImpl : public IModuleInterface {};
// Programs of the tests find a module by the function of its name.
#define IMPLEMENT_MODULE(Type, Name) \
  IModuleInterface& Module##Name() { \
    static Type module;              \
    return module;                   \
  }
