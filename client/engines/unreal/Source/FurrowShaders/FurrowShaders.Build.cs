// SPDX-License-Identifier: Apache-2.0
using UnrealBuildTool;

public class FurrowShaders : ModuleRules
{
	public FurrowShaders(ReadOnlyTargetRules Target) : base(Target)
	{
		PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
		PrivateDependencyModuleNames.AddRange(new string[] { "Core", "Projects", "RenderCore" });
	}
}
