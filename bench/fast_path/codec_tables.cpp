// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include "bench/fast_path/tables.h"
#include "bench/report/value_or_exit.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;

// The results of bench_codec as table cells, by the names of the benchmarks.
class Cells {
 public:
  explicit Cells(const MicroResults& results) : results_(results) {}

  [[nodiscard]] std::string Nanoseconds(const std::string& name) const {
    return Fixed(ValueOrExit(results_.Nanoseconds(name)), 0);
  }
  // "364 (2.4 GB/s)"
  [[nodiscard]] std::string WithRate(const std::string& name) const {
    return Nanoseconds(name) + " (" + Fixed(BytesPerSecond(name) * 1e-9, 1) + " GB/s)";
  }
  [[nodiscard]] std::string Ratio(const std::string& name, const std::string& of) const {
    return Fixed(ValueOrExit(results_.Nanoseconds(name)) / ValueOrExit(results_.Nanoseconds(of)),
                 1) +
           "x";
  }
  // Per message.
  [[nodiscard]] std::string Bytes(const std::string& name) const {
    return Fixed(BytesPerSecond(name) * ValueOrExit(results_.Nanoseconds(name)) * 1e-9, 0);
  }
  [[nodiscard]] std::string Count(const std::string& name, const std::string& counter) const {
    return Fixed(ValueOrExit(results_.Counter(name, counter)), 0);
  }

 private:
  [[nodiscard]] double BytesPerSecond(const std::string& name) const {
    return ValueOrExit(results_.Counter(name, "bytes_per_second"));
  }
  const MicroResults& results_;
};

// The cost of reading and writing, after their baselines.
void AddReadAndWrite(const Cells& cells, const std::string& of, std::vector<std::string>* row) {
  row->insert(row->end(),
              {cells.Nanoseconds("BM_ReadPlain" + of), cells.WithRate("BM_Decode" + of),
               cells.Ratio("BM_Decode" + of, "BM_ReadPlain" + of), cells.WithRate("BM_Encode" + of),
               cells.Ratio("BM_Encode" + of, "BM_Copy" + of)});
}

report::Table Poses(const Cells& cells) {
  report::Table table{
      "The codec: poses, ns of processor time per message",
      {"joints", "as", "bytes", "copy", "copy again", "FlatBuffers: verify",
       "FlatBuffers: verify, read", "decode", "of FlatBuffers", "encode", "of the copy"},
      {}};
  for (const std::string joints : {"51", "60", "163"}) {
    for (const bool packed : {false, true}) {
      const std::string arguments = "/joints:" + joints + "/packed:" + (packed ? "1" : "0");
      std::vector<std::string> row{joints,
                                   packed ? "packed" : "full",
                                   cells.Bytes("BM_CopyPose" + arguments),
                                   cells.Nanoseconds("BM_CopyPose" + arguments),
                                   cells.Nanoseconds("BM_CopyPoseAgain" + arguments),
                                   cells.Nanoseconds("BM_VerifyPlainPose" + arguments)};
      AddReadAndWrite(cells, "Pose" + arguments, &row);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

report::Table Weights(const Cells& cells) {
  report::Table table{"The codec: 37 weights, ns of processor time per message",
                      {"as", "bytes", "copy", "FlatBuffers: verify, read", "decode",
                       "of FlatBuffers", "encode", "of the copy"},
                      {}};
  for (const bool u8 : {false, true}) {
    const std::string of = std::string("Weights/u8:") + (u8 ? "1" : "0");
    std::vector<std::string> row{u8 ? "u8" : "f32", cells.Bytes("BM_Copy" + of),
                                 cells.Nanoseconds("BM_Copy" + of)};
    AddReadAndWrite(cells, of, &row);
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table Fragments(const Cells& cells) {
  report::Table table{"The codec: messages above one datagram, ns of processor time per message",
                      {"message", "bytes", "datagrams", "copy", "split", "of the copy",
                       "reassemble", "of the copy", "allocations"},
                      {}};
  const std::pair<const char*, const char*> messages[] = {{"0", "pose of 163 joints in floats"},
                                                          {"163", "offer of 163 joints"},
                                                          {"1024", "offer of 1,024 joints"}};
  for (const auto& [argument, what] : messages) {
    const std::string copy = std::string("BM_CopyFragmented/offered:") + argument;
    const std::string cut = std::string("BM_Fragment/offered:") + argument;
    const std::string whole = std::string("BM_Reassemble/offered:") + argument;
    table.rows.push_back({what, cells.Bytes(copy), cells.Count(cut, "datagrams"),
                          cells.Nanoseconds(copy), cells.WithRate(cut), cells.Ratio(cut, copy),
                          cells.WithRate(whole), cells.Ratio(whole, copy),
                          cells.Count(whole, "allocations")});
  }
  return table;
}

}  // namespace

std::string CodecTables(const MicroResults& results) {
  const Cells cells(results);
  return report::ToMarkdown(Poses(cells)) + "\n" + report::ToMarkdown(Weights(cells)) + "\n" +
         report::ToMarkdown(Fragments(cells));
}

}  // namespace furrow::bench
