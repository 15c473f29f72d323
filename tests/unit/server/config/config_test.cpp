// SPDX-License-Identifier: Apache-2.0
#include "server/config/config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::HasSubstr;

CommandLine Parse(std::vector<std::string> args) { return ParseCommandLine(args); }

Status ParseText(std::string_view text, Config* config) {
  return ParseConfig(text, "furrow.toml", config);
}

class ConfigFile {
 public:
  explicit ConfigFile(std::string_view text) {
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".toml");
    std::ofstream(path_) << text;
  }
  ~ConfigFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(CommandLine, DefaultsListenOnLoopbackOnly) {
  const CommandLine line = Parse({});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_EQ(line.config->bind, "127.0.0.1");
  EXPECT_EQ(line.config->tcp, 7400);
  EXPECT_EQ(line.config->udp, 7401);
  EXPECT_TRUE(line.config->render);
  EXPECT_FALSE(line.config->vmc.has_value());
}

TEST(CommandLine, EveryFlagReachesTheConfig) {
  const CommandLine line = Parse({"--character",
                                  "a.glb",
                                  "--rig",
                                  "b.json",
                                  "--skeleton-map",
                                  "mixamo",
                                  "--shape-map",
                                  "vrm0",
                                  "--bind",
                                  "::1",
                                  "--tcp",
                                  "1",
                                  "--udp",
                                  "2",
                                  "--rest-frame",
                                  "12",
                                  "--up-axis",
                                  "z",
                                  "--no-render",
                                  "--vmc",
                                  "3",
                                  "--livelink-face",
                                  "4",
                                  "--mocap-allow",
                                  "10.0.0.1",
                                  "--mocap-allow",
                                  "::2",
                                  "--allow-host",
                                  "furrow.example",
                                  "--allow-host",
                                  "stage",
                                  "--osc-out",
                                  "127.0.0.1:9000",
                                  "--osc-prefix",
                                  "stage",
                                  "--record",
                                  "takes",
                                  "--record-rotate-megabytes",
                                  "10",
                                  "--record-rotate-seconds",
                                  "0",
                                  "--verbose",
                                  "--log-json",
                                  "--render-device",
                                  "surfaceless"});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  const Config& config = *line.config;
  EXPECT_EQ(config.character, "a.glb");
  EXPECT_EQ(config.rig, "b.json");
  EXPECT_EQ(config.skeleton_map, "mixamo");
  EXPECT_EQ(config.shape_map, "vrm0");
  EXPECT_EQ(config.bind, "::1");
  EXPECT_EQ(config.tcp, 1);
  EXPECT_EQ(config.udp, 2);
  // The rig's reference poses keep the rest poses of their files.
  EXPECT_EQ(PlayOptions(config).rest_frame, 12);
  EXPECT_EQ(ReadOptions(config).rest_frame, -1);
  EXPECT_EQ(PlayOptions(config).up_axis, motion::UpAxis::kZ);
  EXPECT_FALSE(config.render);
  EXPECT_EQ(config.vmc, 3);
  EXPECT_EQ(config.livelink_face, 4);
  EXPECT_THAT(config.mocap_allow, testing::ElementsAre("10.0.0.1", "::2"));
  EXPECT_THAT(config.http.allow_hosts, testing::ElementsAre("furrow.example", "stage"));
  ASSERT_TRUE(config.osc_out.has_value());
  EXPECT_EQ(config.osc_out->host, "127.0.0.1");
  EXPECT_EQ(config.osc_out->port, 9000);
  EXPECT_EQ(config.osc_prefix, "stage");
  EXPECT_EQ(config.record.folder, "takes");
  EXPECT_DOUBLE_EQ(config.record.rotate_megabytes, 10.0);
  EXPECT_DOUBLE_EQ(config.record.rotate_seconds, 0.0);
  EXPECT_TRUE(config.verbose);
  EXPECT_TRUE(config.log_json);
  EXPECT_EQ(config.render_device, "surfaceless");
}

TEST(CommandLine, HelpListsExitCodesAndSucceeds) {
  const CommandLine line = Parse({"--help"});
  EXPECT_FALSE(line.config.has_value());
  EXPECT_EQ(line.exit_code, ExitCode::kOk);
  EXPECT_THAT(line.text, HasSubstr("Exit codes: 0"));
  EXPECT_THAT(line.text, HasSubstr("--livelink-face"));
}

TEST(CommandLine, InvalidUsageExitsWithTwo) {
  for (const std::vector<std::string>& args :
       std::vector<std::vector<std::string>>{{"--nonsense"},
                                             {"--tcp", "70000"},
                                             {"--tcp", "x"},
                                             {"--bind", "localhost"},
                                             {"--osc-out", "nowhere"},
                                             {"--mocap-allow", "stage-pc"},
                                             {"--vmc", "7401"},
                                             {"--allow-host", "http://stage"},
                                             {"--allow-host", "stage:7480"},
                                             {"--threads", "0"},
                                             {"--threads", "65"},
                                             {"--busy-poll", "-1"},
                                             {"--busy-poll", "100001"},
                                             {"--require-render", "--no-render"}}) {
    const CommandLine line = Parse(args);
    EXPECT_FALSE(line.config.has_value()) << args[0];
    EXPECT_EQ(line.exit_code, ExitCode::kUsage) << args[0];
    EXPECT_FALSE(line.text.empty()) << args[0];
  }
}

TEST(CommandLine, ErrorsNameWhatWasMeantAndTheRange) {
  EXPECT_EQ(Parse({"--tpc", "7400"}).text,
            "unknown option '--tpc'; did you mean '--tcp'? ('furrowd --help' lists the options)\n");
  EXPECT_EQ(Parse({"--no-rendr"}).text,
            "unknown option '--no-rendr'; did you mean '--no-render'? ('furrowd --help' lists the "
            "options)\n");
  EXPECT_EQ(Parse({"serve"}).text,
            "unexpected argument 'serve' ('furrowd --help' lists the options)\n");
  EXPECT_THAT(Parse({"--tcp", "70000"}).text,
              HasSubstr("--tcp: '70000' is not a port from 0 to 65535"));
  EXPECT_THAT(Parse({"--threads", "65"}).text,
              HasSubstr("--threads: '65' is not a number of threads from 1 to 64"));
  EXPECT_THAT(Parse({"--busy-poll", "1s"}).text,
              HasSubstr("--busy-poll: '1s' is not a time in microseconds from 0 to 100000"));
  EXPECT_THAT(Parse({"--record-rotate-seconds", "nan"}).text, HasSubstr("from 0 to 1e+09"));
}

TEST(CommandLine, OnlyOpenListensBeyondThisComputer) {
  for (const char* address : {"0.0.0.0", "192.168.0.10", "::"}) {
    const CommandLine line = Parse({"--bind", address});
    EXPECT_EQ(line.exit_code, ExitCode::kUsage) << address;
    EXPECT_THAT(line.text, HasSubstr("--open")) << address;
    const CommandLine open = Parse({"--bind", address, "--open"});
    ASSERT_TRUE(open.config.has_value()) << open.text;
    EXPECT_TRUE(ListensToNetwork(*open.config));
  }
  for (const char* address : {"127.0.0.1", "127.0.0.2", "::1"}) {
    const CommandLine line = Parse({"--bind", address});
    ASSERT_TRUE(line.config.has_value()) << line.text;
    EXPECT_FALSE(ListensToNetwork(*line.config));
  }
}

TEST(CommandLine, TokensLetOthersInWithoutOpen) {
  const CommandLine line =
      Parse({"--bind", "0.0.0.0", "--security", "required", "--keys", "a.keys", "--name", "stage"});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_EQ(line.config->security, (SecurityConfig{Security::kRequired, "a.keys", "stage", false}));
  EXPECT_FALSE(line.config->open);
}

TEST(CommandLine, SecurityMustNotContradictItself) {
  const auto why = [](const std::vector<std::string>& args) { return Parse(args).text; };
  EXPECT_THAT(why({"--security", "required"}), HasSubstr("--keys"));
  EXPECT_THAT(why({"--security", "closed"}), HasSubstr("closed"));
  EXPECT_THAT(why({"--security", "required", "--keys", "k", "--open"}),
              HasSubstr("cannot be combined"));
  EXPECT_THAT(why({"--name", std::string(48, 'n')}), HasSubstr("--name"));
  // Phones can show no token.
  const std::vector<std::string> phones = {"--bind", "0.0.0.0", "--security", "required",
                                           "--keys", "k",       "--vmc",      "39539"};
  EXPECT_THAT(why(phones), HasSubstr("--mocap-allow"));
  std::vector<std::string> named = phones;
  named.insert(named.end(), {"--mocap-allow", "10.0.0.7"});
  EXPECT_TRUE(Parse(named).config.has_value());
}

TEST(CommandLine, FlagsOverrideTheFileAndTheFileTheDefaults) {
  const ConfigFile file(
      "[listen]\ntcp = 100\nudp = 200\n[mocap]\nvmc = 300\n"
      "allow = ['10.0.0.1', '10.0.0.2']\n");
  CommandLine line = Parse({"--config", file.path(), "--tcp", "101"});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_EQ(line.config->tcp, 101);
  EXPECT_EQ(line.config->udp, 200);
  EXPECT_EQ(line.config->vmc, 300);
  EXPECT_THAT(line.config->mocap_allow, testing::ElementsAre("10.0.0.1", "10.0.0.2"));
  line = Parse({"--config", file.path(), "--mocap-allow", "10.0.0.3"});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_THAT(line.config->mocap_allow, testing::ElementsAre("10.0.0.3"));
}

TEST(CommandLine, JitterBuffersAreRulesThatReplaceThoseOfTheFile) {
  const ConfigFile file("[listen]\njitter_buffer = [\"60\", \"phone-*,tablet=80.5\"]\n");
  CommandLine line = Parse({"--config", file.path()});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_THAT(line.config->jitter,
              testing::ElementsAre(JitterRule{"*", 60.0}, JitterRule{"phone-*,tablet", 80.5}));
  line = Parse({"--config", file.path(), "--jitter-buffer", "5", "--jitter-buffer", "ada=0"});
  ASSERT_TRUE(line.config.has_value()) << line.text;
  EXPECT_THAT(line.config->jitter,
              testing::ElementsAre(JitterRule{"*", 5.0}, JitterRule{"ada", 0.0}));
  for (const char* wrong : {"", "x", "5ms", "-1", "1001", "nan", "=5", "ada=", "ada=5,6"}) {
    const CommandLine failed = Parse({"--jitter-buffer", wrong});
    EXPECT_EQ(failed.exit_code, ExitCode::kUsage) << wrong;
    EXPECT_THAT(failed.text, HasSubstr("--jitter-buffer")) << wrong;
  }
}

TEST(CommandLine, AnErrorInTheFileNamesTheLine) {
  const ConfigFile file("[listen]\nbind = \"127.0.0.1\"\nport = 7\n");
  const CommandLine line = Parse({"--config", file.path()});
  EXPECT_EQ(line.exit_code, ExitCode::kBadInput);
  EXPECT_THAT(line.text, HasSubstr(file.path() + ":3"));
  EXPECT_THAT(line.text, HasSubstr("listen.port"));
}

TEST(CommandLine, AValueOutOfRangeNamesTheLine) {
  const auto error = [](const char* text) {
    const ConfigFile file(text);
    const CommandLine line = Parse({"--config", file.path()});
    EXPECT_EQ(line.exit_code, ExitCode::kBadInput) << text;
    // Without the folder.
    return line.text.substr(std::min(line.text.size(), line.text.rfind(".toml")));
  };
  EXPECT_EQ(error("[limits]\n\nmax_subjects = 0\n"),
            ".toml:3: limits.max_subjects is 0; it must be 1 to 1000000\n");
  EXPECT_THAT(error("[listen]\nthreads = 99\n"), HasSubstr(".toml:2: --threads is 99"));
  EXPECT_THAT(error("[listen]\nbusy_poll_us = -1\n"), HasSubstr(".toml:2: --busy-poll is -1"));
  EXPECT_THAT(error("rest_frame = -5\n"), HasSubstr(".toml:1: --rest-frame: -5"));
  EXPECT_THAT(error("http = {api_share = 2}\n"), HasSubstr(".toml:1: http.api_share is 2"));
  EXPECT_THAT(error("[osc]\nallow = ['stage']\n"), HasSubstr(".toml:2: osc.allow: 'stage'"));
  // Of a value that the file does not set, and of a flag.
  EXPECT_THAT(error("[limits]\nmax_subscriptions = 20000\n"),
              HasSubstr(".toml: limits.max_all_subscriptions is 16384"));
  EXPECT_THAT(error("[listen]\nbind = 'here'\n"), HasSubstr(".toml: --bind: 'here'"));
}

TEST(CommandLine, ErrorsAreInJsonIfTheFlagOrTheFileAsksForIt) {
  const ConfigFile faulty("[limits]\nmax_subjects = 0\n[log]\njson = true\n");
  EXPECT_TRUE(Parse({"--config", faulty.path()}).log_json) << "the file was read as a whole";
  EXPECT_TRUE(Parse({"--log-json", "--config", "/nowhere/furrow.toml"}).log_json);
  EXPECT_TRUE(Parse({"--no-such-option", "--log-json"}).log_json);
  EXPECT_TRUE(Parse({"--log-json"}).log_json);
  EXPECT_FALSE(Parse({"--config", "/nowhere/furrow.toml"}).log_json);
  EXPECT_FALSE(Parse({"--no-such-option"}).log_json);
}

TEST(CommandLine, AMissingFileIsBadInput) {
  const CommandLine line = Parse({"--config", "/nowhere/furrow.toml"});
  EXPECT_EQ(line.exit_code, ExitCode::kBadInput);
  EXPECT_THAT(line.text, HasSubstr("/nowhere/furrow.toml"));
}

TEST(ParseConfig, ReadsEveryTable) {
  Config config;
  const Status status = ParseText(
      "character = 'face.glb'\nrig = '/abs/rig.json'\nskeleton_map = 'cmu'\nshape_map = 'cc4'\n"
      "rest_frame = 7\nup_axis = 'y'\n"
      "[listen]\nbind = '0.0.0.0'\nopen = true\ntcp = 0\nudp = 1\nthreads = 3\nbusy_poll_us = 50\n"
      "[security]\nmode = 'required'\nkeys = '/abs/a.keys'\nname = 'n'\ntokens_in_clear = true\n"
      "[render]\nenabled = true\nrequired = true\ndevice = '1'\nmax_video_encoders = 3\n"
      "max_host_megapixels_per_second = 4.5\nmax_megapixels_per_second = 90\n"
      "[mocap]\nvmc = 39539\nlivelink_face = 11111\n"
      "[osc]\nout = '[::1]:9000'\nprefix = 'x'\nallow = ['10.0.0.7']\n"
      "[[osc.target]]\nto = '10.0.0.8:39539'\nprofile = 'vmc'\nsubject = 'ada'\n"
      "[[osc.target]]\nto = '127.0.0.1:9001'\nprofile = './mine.toml'\nprefix = 'p'\n"
      "pattern = 'brow_*'\nrate_hz = 30\n"
      "[record]\ndir = 'takes'\nrotate_megabytes = 2\nrotate_seconds = 60\ndatagrams = false\n"
      "[log]\nverbose = true\njson = true\n"
      "[limits]\nmax_subjects = 5\nidle_seconds = 2.5\npacket_burst = 10\n",
      &config);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(config.character, "face.glb");
  EXPECT_EQ(config.threads, 3);
  EXPECT_EQ(config.busy_poll_us, 50);
  EXPECT_EQ(config.security, (SecurityConfig{Security::kRequired, "/abs/a.keys", "n", true}));
  EXPECT_EQ(config.rig, "/abs/rig.json");
  EXPECT_EQ(config.skeleton_map, "cmu");
  EXPECT_EQ(config.shape_map, "cc4");
  EXPECT_EQ(config.rest_frame, 7);
  EXPECT_EQ(config.up_axis, "y");
  EXPECT_TRUE(config.require_render);
  EXPECT_EQ(config.max_video_encoders, 3);
  EXPECT_DOUBLE_EQ(config.max_host_megapixels_per_second, 4.5);
  EXPECT_DOUBLE_EQ(config.max_megapixels_per_second, 90.0);
  EXPECT_EQ(config.osc_out->host, "::1");
  EXPECT_THAT(config.osc.allow, testing::ElementsAre("10.0.0.7"));
  ASSERT_EQ(config.osc.targets.size(), 2u);
  EXPECT_EQ(config.osc.targets[0],
            (OscTargetConfig{{"10.0.0.8", 39539}, "vmc", "furrow", "ada", "*", 0}));
  EXPECT_EQ(config.osc.targets[1],
            (OscTargetConfig{{"127.0.0.1", 9001}, "./mine.toml", "p", "", "brow_*", 30}));
  EXPECT_EQ(config.record, (RecordConfig{"takes", 2.0, 60.0, false}));
  EXPECT_EQ(config.limits.max_subjects, 5);
  EXPECT_DOUBLE_EQ(config.limits.idle_seconds, 2.5);
  EXPECT_DOUBLE_EQ(config.limits.packet_burst, 10.0);
  EXPECT_EQ(config.limits.max_connections, Limits().max_connections);
}

TEST(ParseConfig, TheExampleShowsTheDefaults) {
  Config config;
  config.tcp = config.udp = 1;
  config.limits.max_subjects = config.limits.max_skeletons = 1;
  const Status status = LoadConfigFile(FURROW_SOURCE_DIR "/server/furrow.example.toml", &config);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(config, Config());
}

TEST(ParseConfig, VideoEncodersAreLimited) {
  Config config;
  for (const auto& [number, good] :
       {std::pair{-1, false}, {0, true}, {1000, true}, {1001, false}}) {
    config.max_video_encoders = number;
    EXPECT_EQ(ValidateConfig(config).ok(), good) << number;
  }
}

TEST(ParseConfig, BudgetsOfPixelsAreLimited) {
  for (double Config::*const budget :
       {&Config::max_host_megapixels_per_second, &Config::max_megapixels_per_second}) {
    for (const auto& [value, good] : {std::pair{-1.0, false},
                                      {0.0, true},
                                      {0.5, true},
                                      {1e6, true},
                                      {1e7, false},
                                      {NAN, false}}) {
      Config config;
      config.*budget = value;
      EXPECT_EQ(ValidateConfig(config).ok(), good) << value;
    }
  }
}

TEST(ParseConfig, RotationLimitsMustNotBeNegative) {
  Config config;
  config.record.rotate_seconds = -1.0;
  EXPECT_EQ(ValidateConfig(config).code(), StatusCode::kInvalidArgument);
  config.record.rotate_seconds = 0.0;
  EXPECT_TRUE(ValidateConfig(config).ok());
}

TEST(ParseConfig, RelativeFilesAreRelativeToTheConfig) {
  Config config;
  ASSERT_TRUE(ParseConfig("rig = 'rig.json'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.rig, "/etc/furrow/rig.json");
  ASSERT_TRUE(ParseConfig("play = 'walk'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.play, "walk");  // a shipped recording
  ASSERT_TRUE(ParseConfig("play = 'walk.bvh'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.play, "/etc/furrow/walk.bvh");
  ASSERT_TRUE(ParseConfig("character = 'elder'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.character, "elder");  // a shipped character
  ASSERT_TRUE(ParseConfig("character = 'me.gltf'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.character, "/etc/furrow/me.gltf");
  ASSERT_TRUE(ParseConfig("skeleton_map = 'my.json'", "/etc/furrow/furrow.toml", &config).ok());
  EXPECT_EQ(config.skeleton_map, "/etc/furrow/my.json");
}

// An empty path switches something off, and is not the folder of the configuration.
TEST(ParseConfig, EmptyPathsAreNone) {
  Config config;
  ASSERT_TRUE(
      ParseConfig("[record]\ndir = ''\n[http]\npage = ''\n[tls]\ncertificate = ''\nkey = ''",
                  "/etc/furrow/furrow.toml", &config)
          .ok());
  EXPECT_TRUE(config.record.folder.empty());
  EXPECT_TRUE(config.http.page.empty());
  EXPECT_FALSE(config.security.tls.enabled());
}

TEST(ParseConfig, OriginsAreThoseThatBrowsersSend) {
  for (const char* origin :
       {"https://stage.example", "http://localhost:3000", "app://furrow", "null"}) {
    Config config;
    config.http.allow_origins = {origin};
    EXPECT_TRUE(ValidateConfig(config).ok()) << origin;
  }
  for (const char* origin :
       {"https://stage.example/", "stage.example", "https://", "://stage", ""}) {
    Config config;
    config.http.allow_origins = {origin};
    EXPECT_FALSE(ValidateConfig(config).ok()) << origin;
  }
}

TEST(ParseConfig, AnErrorLeavesTheConfigUnchanged) {
  struct Case {
    const char* text;
    StatusCode code;
    const char* where;
    const char* what;
  };
  for (const Case& fault :
       {Case{"[listen\n", StatusCode::kParse, ":1", ""},
        Case{"a = 1", StatusCode::kSchema, ":1", "unknown key 'a'"},
        Case{"[listen]\ntpc = 1", StatusCode::kSchema, ":2",
             "unknown key 'listen.tpc'; did you mean 'listen.tcp'?"},
        Case{"[recrod]\ndir = 'x'", StatusCode::kSchema, ":", "did you mean 'record'?"},
        Case{"listen = 3", StatusCode::kSchema, ":1", "listen"},
        Case{"[listen]\n\ntcp = -1", StatusCode::kSchema, ":3", "listen.tcp"},
        Case{"[listen]\nudp = 65536", StatusCode::kSchema, ":2", "listen.udp"},
        Case{"[listen]\nbind = 7", StatusCode::kSchema, ":2", "listen.bind"},
        Case{"[log]\njson = 'yes'", StatusCode::kSchema, ":2", "log.json"},
        Case{"[osc]\nout = 'x'", StatusCode::kSchema, ":2", "osc.out"},
        Case{"[[osc.target]]\nto = '127.0.0.1:9000'\n[[osc.target]]\nto = 'x'", StatusCode::kSchema,
             "", "osc.target number 2: to 'x'"},
        Case{"[osc]\ntarget = 3", StatusCode::kSchema, ":2", "osc.target must be a list of tables"},
        Case{"[osc]\ntarget = [3]", StatusCode::kSchema, ":2", "number 1: must be a table"},
        Case{"[limits]\nmax_subjects = 1.5", StatusCode::kSchema, ":2", "limits.max_subjects"},
        Case{"[limits]\nmax_subjects = -9223372036854775808", StatusCode::kSchema, ":2",
             "limits.max_subjects"},
        Case{"[limits]\nidle_seconds = 'x'", StatusCode::kSchema, ":2", "limits.idle_seconds"}}) {
    Config config;
    config.tcp = 4711;
    const Status status = ParseText(fault.text, &config);
    EXPECT_EQ(status.code(), fault.code) << fault.text;
    EXPECT_THAT(status.where(), HasSubstr(std::string("furrow.toml") + fault.where)) << fault.text;
    EXPECT_THAT(status.what(), HasSubstr(fault.what)) << fault.text;
    EXPECT_EQ(config.tcp, 4711) << fault.text;
  }
}

TEST(ValidateConfig, NamesTheLimitThatIsOutOfRange) {
  Config config;
  config.limits.max_subjects = 0;
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("limits.max_subjects"));
  config = {};
  config.limits.max_subscriptions = 20'000;
  EXPECT_THAT(ValidateConfig(config).what(),
              HasSubstr("limits.max_all_subscriptions is 16384; it must be at least "
                        "limits.max_subscriptions, 20000"));
  config.limits.max_all_subscriptions = 20'000;
  EXPECT_TRUE(ValidateConfig(config).ok());
  config.limits.max_all_subscriptions = 1'000'001;
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("limits.max_all_subscriptions"));
  config = {};
  config.limits.max_waiting_megabytes = 71;
  EXPECT_THAT(ValidateConfig(config).what(),
              HasSubstr("limits.max_waiting_megabytes is 71; it must be 72 to 1000000"));
  config = {};
  config.http.max_upload_megabytes = 0;
  EXPECT_TRUE(ValidateConfig(config).ok());
  config.http.max_upload_megabytes = 1001;
  EXPECT_THAT(ValidateConfig(config).what(),
              HasSubstr("http.max_upload_megabytes is 1001; it must be 0 to 1000"));
  config = {};
  config.limits.loss_seconds = 0.0;
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("limits.loss_seconds"));
  config = {};
  config.osc_prefix = "a b";
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("osc.prefix"));
  config = {};
  config.osc.targets = {{.to = {"127.0.0.1", 9000}, .rate_hz = 1e9}};
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("osc.target: rate_hz"));
  config = {};
  config.osc.allow = {"stage"};
  EXPECT_THAT(ValidateConfig(config).what(), HasSubstr("osc.allow: 'stage'"));
}

TEST(ValidateConfig, FramesCountFrom0) {
  Config config;
  config.rest_frame = -2;
  EXPECT_THAT(ValidateConfig(config).what(), testing::HasSubstr("--rest-frame"));
}

TEST(ValidateConfig, NamesTheAxesThatMayPointUp) {
  Config config;
  config.up_axis = "x";
  EXPECT_THAT(ValidateConfig(config).what(), testing::HasSubstr("--up-axis: 'x' is not one of"));
}

TEST(ValidateConfig, SeveralServicesMayUsePortZero) {
  Config config;
  config.udp = 0;
  config.vmc = 0;
  EXPECT_TRUE(ValidateConfig(config).ok());
}

TEST(ParseHostPort, AcceptsNumericAddressesOnly) {
  ASSERT_TRUE(ParseHostPort("10.0.0.1:80").ok());
  EXPECT_EQ(ParseHostPort("[fe80::1]:65535")->host, "fe80::1");
  for (const char* bad : {"", ":", "host:80", "1.2.3.4", "1.2.3.4:", "1.2.3.4:0", "1.2.3.4:65536",
                          "1.2.3.4:8x", "::1:80", "[::1]"}) {
    EXPECT_FALSE(ParseHostPort(bad).ok()) << bad;
  }
}

}  // namespace
}  // namespace furrow::server
