// SPDX-License-Identifier: Apache-2.0
// The Live Link source with a client that counts. Arguments: the address, and the number of frames to receive.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "FurrowLiveLinkSourceFactory.h"
#include "FurrowSceneTime.h"
#include "ILiveLinkClient.h"
#include "Roles/LiveLinkBasicRole.h"

namespace {

void Check(bool condition, const char* what) {
  if (condition) return;
  std::printf("check failed: %s\n", what);
  std::exit(1);
}

struct Subject {
  TArray<FName> names;
  long frames = 0;
  float highest = 0.0f;
  int32 scene_rate = 0;  // frames per second of the timecode, of the newest frame
  int32 first_scene_frame = 0;
  bool scene_moves = false;  // its timecode changes
};

class Client : public ILiveLinkClient {
 public:
  void PushSubjectStaticData_AnyThread(const FLiveLinkSubjectKey& key, UClass* role,
                                       FLiveLinkStaticDataStruct&& data) override {
    Check(role == ULiveLinkBasicRole::StaticClass(), "the basic role");
    subjects[key.SubjectName.Name.ToString()].names = data.Cast<FLiveLinkBaseStaticData>()->PropertyNames;
  }
  void PushSubjectFrameData_AnyThread(const FLiveLinkSubjectKey& key, FLiveLinkFrameDataStruct&& data) override {
    Check(key.Source.value == 7, "the source's number");
    Subject& subject = subjects[key.SubjectName.Name.ToString()];
    const FLiveLinkBaseFrameData& frame = *data.Cast<FLiveLinkBaseFrameData>();
    Check(frame.PropertyValues.Num() == subject.names.Num() && subject.names.Num() > 50, "names come first");
    Check(frame.WorldTime.seconds_ >= last_time, "time ascends");
    last_time = frame.WorldTime.seconds_;
    const FQualifiedFrameTime& scene = frame.MetaData.SceneTime;
    subject.scene_rate = scene.Rate.Denominator == 1 ? scene.Rate.Numerator : 0;
    if (subject.frames == 0) subject.first_scene_frame = scene.Time.FrameNumber.Value;
    subject.scene_moves |= scene.Time.FrameNumber.Value != subject.first_scene_frame;
    ++subject.frames;
    for (int32 i = 0; i < subject.names.Num(); ++i) {
      if (subject.names[i].ToString() == "brow_l.squash") {
        subject.highest = std::max(subject.highest, frame.PropertyValues[i]);
      }
    }
  }
  std::map<std::string, Subject> subjects;
  double last_time = 0.0;
};

void Tell(const char* event, const std::string& more = {}) {
  std::printf("furrow-test: {\"event\": \"%s\"%s}\n", event, more.c_str());
  std::fflush(stdout);
}

// A frame with a timecode at 30000/1001 frames per second.
furrow_frame FrameAt(const char* timecode) {
  furrow_frame frame{};
  frame.struct_size = sizeof frame;
  std::snprintf(frame.timecode, sizeof frame.timecode, "%s", timecode);
  frame.timecode_rate_numerator = 30000;
  frame.timecode_rate_denominator = 1001;
  return frame;
}

void CheckSceneTimes() {
  furrow_frame frame = FrameAt("01:10:00;00");
  // 70 minutes at 29.97 frames per second.
  Check(SceneTimeOf(frame).Time.FrameNumber.Value == 125874, "drop-frame");
  Check(SceneTimeOf(frame).Rate.Numerator == 30000 && SceneTimeOf(frame).Rate.Denominator == 1001, "the rate");
  Check(SceneTimeOf(FrameAt("00:00:01:05")).Time.FrameNumber.Value == 35, "without drop-frame");
  frame.struct_size = 56;
  for (const furrow_frame& none : {FrameAt(""), FrameAt("later"), frame}) {
    Check(SceneTimeOf(none).Rate.Numerator == FQualifiedFrameTime().Rate.Numerator, "no timecode");
  }
}

}  // namespace

int main(int, char** arguments) {
  CheckSceneTimes();
  const long needed = std::atol(arguments[2]);
  const UFurrowLiveLinkSourceFactory factory;
  Client client;
  auto source = factory.CreateSource(arguments[1]);
  source->ReceiveClient(&client, FGuid{7});
  Check(source->IsSourceStillValid(), "valid from the beginning");
  Check(source->GetSourceStatus().ToString() == "Connecting", "connecting");
  const auto tick = [&] {
    source->Update();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  };
  // The performance raises the brows within its 10 s.
  while (client.subjects["ada"].frames < needed || client.subjects["bob"].frames < needed ||
         client.subjects["ada"].highest <= 0.2f) {
    tick();
  }
  while (!client.subjects["cam"].scene_moves) tick();
  Check(client.subjects["cam"].scene_rate == 60, "the phone's timecode");
  Check(client.subjects["cam"].first_scene_frame >= 36000 * 60, "it begins at 10:00:00:00");
  Check(client.subjects["ada"].scene_rate == 0 && !client.subjects["ada"].scene_moves, "BVH has no timecode");
  const std::string status = source->GetSourceStatus().ToString();
  // "Connected, 3 ms old, 0 missed, 77 names": the frames were consecutive.
  Check(status.find("Connected, ") == 0 && status.find(" 0 missed, ") != std::string::npos, status.c_str());
  Tell("received", ", \"runs\": {\"ada\": " + std::to_string(client.subjects["ada"].frames) +
                       ", \"bob\": " + std::to_string(client.subjects["bob"].frames) + "}");
  while (source->GetSourceStatus().ToString() != "Connection lost, trying again") tick();
  Tell("lost");
  client.subjects["ada"].frames = client.subjects["bob"].frames = 0;
  while (client.subjects["ada"].frames == 0 || client.subjects["bob"].frames == 0) tick();
  Tell("again");
  Check(source->RequestSourceShutdown() && !source->IsSourceStillValid(), "ends at once");
  source->Update();
  const auto broken = factory.CreateSource("http://127.0.0.1");
  broken->ReceiveClient(&client, FGuid{8});
  broken->Update();
  Check(!broken->IsSourceStillValid() && broken->GetSourceStatus().ToString().find("furrow://") != std::string::npos,
        "an invalid address is explained");
  Check(factory.CreateSource("")->GetSourceMachineName().ToString() == "furrow://127.0.0.1", "the default address");
  Tell("end");
}
