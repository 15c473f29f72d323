// SPDX-License-Identifier: Apache-2.0
// Makes the plug-in's folder Shaders known as /Plugin/Furrow, so that Custom nodes include exported shaders by that path. A
// module of its own, because Unreal takes such folders before the engine starts (LoadingPhase PostConfigInit).
#include "CoreMinimal.h"
#include "Interfaces/IPluginManager.h"
#include "Misc/Paths.h"
#include "Modules/ModuleManager.h"
#include "ShaderCore.h"

class FFurrowShadersModule : public IModuleInterface
{
public:
	virtual void StartupModule() override
	{
		const FString Folder = FPaths::Combine(IPluginManager::Get().FindPlugin(TEXT("Furrow"))->GetBaseDir(), TEXT("Shaders"));
		AddShaderSourceDirectoryMapping(TEXT("/Plugin/Furrow"), Folder);
	}
};

IMPLEMENT_MODULE(FFurrowShadersModule, FurrowShaders)
