// SPDX-License-Identifier: Apache-2.0
using System.IO;
using UnrealBuildTool;

// Not "Furrow": the macro FURROW_API of such a module would be that of furrow.h.
public class FurrowLiveLink : ModuleRules
{
	public FurrowLiveLink(ReadOnlyTargetRules Target) : base(Target)
	{
		PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
		bEnableExceptions = true;  // furrow.hpp reports errors by exceptions
		PublicDependencyModuleNames.AddRange(new string[] { "Core", "CoreUObject", "Engine", "LiveLinkInterface" });

		// What `cmake --install` of Furrow wrote: include/furrow and lib/libfurrow.so.1.
		string Installed = Path.Combine(PluginDirectory, "ThirdParty", "Furrow");
		string Library = Path.Combine(Installed, "lib", "libfurrow.so");
		PrivateIncludePaths.Add(Path.Combine(Installed, "include"));
		PublicAdditionalLibraries.Add(Library);
		RuntimeDependencies.Add(Library + ".1");
		PublicRuntimeLibraryPaths.Add(Path.Combine(Installed, "lib"));
	}
}
