// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "CoreMinimal.h"
#include "Misc/QualifiedFrameTime.h"

struct UScriptStruct {};
struct UClass {};

struct FLiveLinkBaseStaticData {
  static UScriptStruct* StaticStruct() { return nullptr; }
  TArray<FName> PropertyNames;
};
struct FLiveLinkWorldTime {
  explicit FLiveLinkWorldTime(double seconds = 0.0) : seconds_(seconds) {}
  double seconds_;
};
struct FLiveLinkMetaData {
  FQualifiedFrameTime SceneTime;
};
struct FLiveLinkBaseFrameData {
  static UScriptStruct* StaticStruct() { return nullptr; }
  FLiveLinkWorldTime WorldTime;
  FLiveLinkMetaData MetaData;
  TArray<float> PropertyValues;
};

// Holds one of the structs above; moved, never copied.
template <class Data>
class TLiveLinkStruct {
 public:
  explicit TLiveLinkStruct(UScriptStruct*) {}
  TLiveLinkStruct(TLiveLinkStruct&&) = default;
  template <class Wanted>
  Wanted* Cast() {
    return &data_;
  }

 private:
  Data data_;
};
using FLiveLinkStaticDataStruct = TLiveLinkStruct<FLiveLinkBaseStaticData>;
using FLiveLinkFrameDataStruct = TLiveLinkStruct<FLiveLinkBaseFrameData>;

struct FLiveLinkSubjectName {
  explicit FLiveLinkSubjectName(FName name) : Name(std::move(name)) {}
  FName Name;
};
struct FLiveLinkSubjectKey {
  FLiveLinkSubjectKey(FGuid source, FLiveLinkSubjectName subject) : Source(source), SubjectName(std::move(subject)) {}
  FGuid Source;
  FLiveLinkSubjectName SubjectName;
};
