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

}  // namespace

int main(int, char** arguments) {
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
