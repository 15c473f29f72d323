// SPDX-License-Identifier: Apache-2.0
#include "base/process/module.h"

#include <dlfcn.h>

#include "base/data_dir.h"

namespace furrow {

std::filesystem::path ModulePath(const std::string& name) {
  return InstallPrefix() / "lib" / "furrow" / name;
}

void* LoadFromModule(const std::filesystem::path& module, const char* function, std::string* why) {
  void* loaded = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* found = loaded == nullptr ? nullptr : dlsym(loaded, function);
  if (found != nullptr) return found;
  const char* reason = dlerror();
  *why = reason != nullptr ? reason : "";
  return nullptr;
}

}  // namespace furrow
