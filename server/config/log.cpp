// SPDX-License-Identifier: Apache-2.0
#include "server/config/log.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <spdlog/async.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "server/config/limited_sink.h"

namespace furrow::server {
namespace {

// Lines that may wait for a slow reader of stderr; the oldest are overwritten.
constexpr std::size_t kMaxWaitingLines = 4096;

// Formats the message as the inside of a JSON string.
class JsonText : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    constexpr char kHex[] = "0123456789abcdef";
    for (const char c : message.payload) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') {
        out.push_back('\\');
        out.push_back(c);
      } else if (byte < 0x20) {
        const char escaped[] = {'\\', 'u', '0', '0', kHex[byte >> 4], kHex[byte & 15]};
        out.append(escaped, escaped + sizeof(escaped));
      } else {
        out.push_back(c);
      }
    }
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JsonText>();
  }
};

// The priority of a line for the journal: "<6>".
class JournalPriority : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    constexpr char kPriorities[] = {'7', '7', '6', '4', '3', '2', '6'};  // by spdlog's levels
    static_assert(sizeof(kPriorities) == spdlog::level::n_levels);
    const char text[] = {'<', kPriorities[message.level], '>'};
    out.append(text, text + sizeof(text));
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalPriority>();
  }
};

spdlog::level::level_enum LevelOf(LogLevel level) {
  switch (level) {
    case LogLevel::kError: return spdlog::level::err;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kInfo: break;
  }
  return spdlog::level::info;
}

// '*': the text in JSON, '@': the priority.
std::string PatternOf(const Log::Settings& settings) {
  const std::string priority = settings.journal ? "%@" : "";
  if (settings.json) {
    return priority + R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l","message":"%*"})";
  }
  return settings.journal ? priority + "%v" : "%H:%M:%S.%e %^%l%$ %v";
}

}  // namespace

Log::Log(const Settings& settings) {
  // One writer keeps the order of the lines.
  spdlog::init_thread_pool(kMaxWaitingLines, /*threads=*/1);
  auto logger = std::make_shared<spdlog::async_logger>(
      "furrowd",
      std::make_shared<LimitedSink>(std::make_shared<spdlog::sinks::stderr_color_sink_mt>()),
      spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest);
  const auto time =
      settings.json ? spdlog::pattern_time_type::utc : spdlog::pattern_time_type::local;
  auto formatter = std::make_unique<spdlog::pattern_formatter>(time);
  formatter->add_flag<JsonText>('*').add_flag<JournalPriority>('@').set_pattern(
      PatternOf(settings));
  logger->set_formatter(std::move(formatter));
  logger->set_level(LevelOf(settings.level));
  logger_ = logger;
  spdlog::set_default_logger(std::move(logger));
}

void Log::SetLevel(LogLevel level) { spdlog::set_level(LevelOf(level)); }

void Log::WriteOut(std::chrono::milliseconds patience) {
  const auto logger = spdlog::default_logger();
  const auto* const sink =
      logger->sinks().empty() ? nullptr : dynamic_cast<LimitedSink*>(logger->sinks()[0].get());
  if (sink == nullptr) return;
  const std::uint64_t before = sink->flushes();
  // Takes its turn behind the lines that wait.
  logger->flush();
  const auto end = std::chrono::steady_clock::now() + patience;
  while (sink->flushes() == before && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

// Writes what is queued and joins the background thread.
Log::~Log() { spdlog::shutdown(); }

}  // namespace furrow::server
