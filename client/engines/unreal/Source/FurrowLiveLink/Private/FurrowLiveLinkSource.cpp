// SPDX-License-Identifier: Apache-2.0
#include "FurrowLiveLinkSource.h"

#include "HAL/PlatformTime.h"
#include "ILiveLinkClient.h"
#include "LiveLinkTypes.h"
#include "Roles/LiveLinkBasicRole.h"

#include "FurrowSceneTime.h"
#include "furrow/furrow.hpp"

// Apart from the header, so that files that use the source do not need Furrow's headers.
struct FFurrowLiveLinkSource::FConnection
{
	explicit FConnection(const std::string& InAddress) : Furrow(InAddress, "furrow-unreal")
	{
		furrow::Callbacks Callbacks;
		Callbacks.on_layout = [this](const char* Subject, uint64_t, const std::vector<std::string>& Names) { PushNames(Subject, Names); };
		Callbacks.on_weights = [this](const char* Subject, const furrow_frame& Frame, const float* Values) { PushValues(Subject, Frame, Values); };
		Furrow.SetCallbacks(std::move(Callbacks));
	}

	void PushNames(const char* Subject, const std::vector<std::string>& Names)
	{
		FLiveLinkStaticDataStruct Data(FLiveLinkBaseStaticData::StaticStruct());
		for (const std::string& Name : Names)
		{
			Data.Cast<FLiveLinkBaseStaticData>()->PropertyNames.Add(FName(UTF8_TO_TCHAR(Name.c_str())));
		}
		Client->PushSubjectStaticData_AnyThread(Key(Subject), ULiveLinkBasicRole::StaticClass(), MoveTemp(Data));
	}

	void PushValues(const char* Subject, const furrow_frame& Frame, const float* Values)
	{
		FLiveLinkFrameDataStruct Data(FLiveLinkBaseFrameData::StaticStruct());
		FLiveLinkBaseFrameData& Base = *Data.Cast<FLiveLinkBaseFrameData>();
		Base.WorldTime = FLiveLinkWorldTime(FPlatformTime::Seconds());
		Base.MetaData.SceneTime = SceneTimeOf(Frame);
		Base.PropertyValues.Append(Values, Frame.count);
		Client->PushSubjectFrameData_AnyThread(Key(Subject), MoveTemp(Data));
	}

	FLiveLinkSubjectKey Key(const char* Subject) const
	{
		return FLiveLinkSubjectKey(SourceGuid, FLiveLinkSubjectName(FName(UTF8_TO_TCHAR(Subject))));
	}

	furrow::Connection Furrow;
	ILiveLinkClient* Client = nullptr;
	FGuid SourceGuid;
};

FFurrowLiveLinkSource::FFurrowLiveLinkSource(const FString& InAddress) : Address(InAddress)
{
	try
	{
		Connection = MakeUnique<FConnection>(std::string(TCHAR_TO_UTF8(*Address)));
	}
	catch (const std::exception& Error)
	{
		Failure = UTF8_TO_TCHAR(Error.what());
	}
}

FFurrowLiveLinkSource::~FFurrowLiveLinkSource() = default;

void FFurrowLiveLinkSource::ReceiveClient(ILiveLinkClient* InClient, FGuid InSourceGuid)
{
	if (Connection)
	{
		Connection->Client = InClient;
		Connection->SourceGuid = InSourceGuid;
	}
}

// Live Link calls it once per tick of the engine.
void FFurrowLiveLinkSource::Update()
{
	try
	{
		if (Connection && Connection->Client) Connection->Furrow.Poll();
	}
	catch (const std::exception& Error)
	{
		Failure = UTF8_TO_TCHAR(Error.what());
		Connection.Reset();
	}
}

bool FFurrowLiveLinkSource::IsSourceStillValid() const { return Connection.IsValid(); }

bool FFurrowLiveLinkSource::RequestSourceShutdown()
{
	Connection.Reset();
	return true;
}

FText FFurrowLiveLinkSource::GetSourceType() const { return FText::FromString(TEXT("Furrow")); }
FText FFurrowLiveLinkSource::GetSourceMachineName() const { return FText::FromString(Address); }

FText FFurrowLiveLinkSource::GetSourceStatus() const
{
	if (!Connection) return FText::FromString(Failure.IsEmpty() ? TEXT("Closed") : *Failure);
	furrow_frame Frame{};
	Frame.struct_size = sizeof Frame;
	const furrow_status Status = furrow_weights(Connection->Furrow.get(), nullptr, nullptr, 0, &Frame);
	switch (Connection->Furrow.Info().state)
	{
	case FURROW_CONNECTING: return FText::FromString(TEXT("Connecting"));
	case FURROW_DISCONNECTED: return FText::FromString(TEXT("Connection lost, trying again"));
	default: break;
	}
	if (Frame.number == 0) return FText::FromString(Status < 0 ? UTF8_TO_TCHAR(furrow_status_text(Status)) : TEXT("Connected, waiting for the subject"));
	return FText::FromString(FString::Printf(TEXT("Connected, %d ms old, %d missed, %d names"), int32(Frame.age_us / 1000), int32(Frame.missed), int32(Frame.count)));
}
