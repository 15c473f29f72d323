// SPDX-License-Identifier: Apache-2.0
#include "FurrowLiveLinkSourceFactory.h"

#include "Misc/ConfigCacheIni.h"

#include "FurrowLiveLinkSource.h"

FText UFurrowLiveLinkSourceFactory::GetSourceDisplayName() const { return FText::FromString(TEXT("Furrow")); }

FText UFurrowLiveLinkSourceFactory::GetSourceTooltip() const
{
	return FText::FromString(TEXT("Wrinkle weights of furrowd; its address is Address in [Furrow] of DefaultEngine.ini"));
}

TSharedPtr<ILiveLinkSource> UFurrowLiveLinkSourceFactory::CreateSource(const FString& ConnectionString) const
{
	FString Address = ConnectionString;
	if (Address.IsEmpty() && !GConfig->GetString(TEXT("Furrow"), TEXT("Address"), Address, GEngineIni))
	{
		Address = TEXT("furrow://127.0.0.1");
	}
	return MakeShared<FFurrowLiveLinkSource>(Address);
}
