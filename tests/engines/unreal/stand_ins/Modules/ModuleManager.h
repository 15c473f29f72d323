// SPDX-License-Identifier: Apache-2.0
#pragma once

struct FDefaultModuleImpl {};
#define IMPLEMENT_MODULE(Type, Name) inline Type module_##Name;
