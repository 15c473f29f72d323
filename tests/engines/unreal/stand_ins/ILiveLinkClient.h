// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "LiveLinkTypes.h"

class ILiveLinkClient {
 public:
  virtual ~ILiveLinkClient() = default;
  virtual void PushSubjectStaticData_AnyThread(const FLiveLinkSubjectKey& key, UClass* role,
                                               FLiveLinkStaticDataStruct&& data) = 0;
  virtual void PushSubjectFrameData_AnyThread(const FLiveLinkSubjectKey& key, FLiveLinkFrameDataStruct&& data) = 0;
};
