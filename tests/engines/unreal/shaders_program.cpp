// SPDX-License-Identifier: Apache-2.0
// Starts the module FurrowShaders and prints the folders that it maps.
#include <cstdio>

#include "Modules/ModuleManager.h"
#include "ShaderCore.h"

IModuleInterface& ModuleFurrowShaders();

void AddShaderSourceDirectoryMapping(const FString& virtual_folder, const FString& folder) {
  std::printf("%s = %s\n", *virtual_folder, *folder);
}

int main() { ModuleFurrowShaders().StartupModule(); }
