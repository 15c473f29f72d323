// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"
#include "ILiveLinkSource.h"
#include "Templates/UniquePtr.h"

/**
 * The subjects of one furrowd as Live Link subjects of the basic role: a property per wrinkle weight, named "<region>.<map>",
 * in [0, 1]. libfurrow connects, and connects again after losses, by itself. Everything runs on the game thread.
 */
class FURROWLIVELINK_API FFurrowLiveLinkSource : public ILiveLinkSource
{
public:
	// Address: "furrow://host?subject=ada&subject=bob"; without subjects, the oldest one.
	explicit FFurrowLiveLinkSource(const FString& InAddress);
	virtual ~FFurrowLiveLinkSource();

	virtual void ReceiveClient(ILiveLinkClient* InClient, FGuid InSourceGuid) override;
	virtual void Update() override;
	virtual bool IsSourceStillValid() const override;
	virtual bool RequestSourceShutdown() override;
	virtual FText GetSourceType() const override;
	virtual FText GetSourceMachineName() const override;
	virtual FText GetSourceStatus() const override;

private:
	struct FConnection;
	FString Address;
	FString Failure;  // why there is no connection
	TUniquePtr<FConnection> Connection;  // null after a failure or a shutdown
};
