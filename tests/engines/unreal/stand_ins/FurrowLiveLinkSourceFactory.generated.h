// SPDX-License-Identifier: Apache-2.0
// Unreal's header tool writes this file.
#pragma once
