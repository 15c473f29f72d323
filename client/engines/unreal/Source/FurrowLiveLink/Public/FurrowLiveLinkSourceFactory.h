// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"
#include "LiveLinkSourceFactory.h"

#include "FurrowLiveLinkSourceFactory.generated.h"

/** Adds "Furrow" to the sources of the Live Link panel. Presets keep the address of a source. */
UCLASS()
class FURROWLIVELINK_API UFurrowLiveLinkSourceFactory : public ULiveLinkSourceFactory
{
	GENERATED_BODY()

public:
	virtual FText GetSourceDisplayName() const override;
	virtual FText GetSourceTooltip() const override;
	virtual EMenuType GetMenuType() const override { return EMenuType::MenuEntry; }
	// ConnectionString: the address; empty: Address in the section [Furrow] of DefaultEngine.ini, or this machine.
	virtual TSharedPtr<ILiveLinkSource> CreateSource(const FString& ConnectionString) const override;
};
