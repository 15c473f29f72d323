// SPDX-License-Identifier: Apache-2.0
#include "bench/fast_path/tables.h"
#include "bench/report/aims.h"
#include "bench/report/value_or_exit.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;

// Nanoseconds per subject and frame.
double ASubject(const MicroResults& results, const std::string& name, int subjects) {
  return ValueOrExit(results.Nanoseconds(name + "/subjects:" + std::to_string(subjects))) /
         subjects;
}

// "169 (3.4x)": the ratio is to copying the poses.
std::string BesideCopy(double nanoseconds, double copy) {
  return Fixed(nanoseconds, 0) + " (" + Fixed(nanoseconds / copy, 1) + "x)";
}

// `solve`: part of the benchmark names.
report::Table Synthetic(const MicroResults& results, const std::string& solve,
                        const std::string& name) {
  report::Table table{"60 pose drivers, " + name + ": ns of processor time per subject and frame",
                      {"subjects", "copy the poses", "one by one, 2 poses", "batch, 2 poses",
                       "one by one, 8 poses", "batch, 8 poses"},
                      {}};
  for (const int subjects : {1, 100, 10000}) {
    const double copy = ASubject(results, "BM_CopyPoses", subjects);
    std::vector<std::string> row{std::to_string(subjects), Fixed(copy, 0)};
    for (const char* poses : {"2", "8"}) {
      for (const char* way : {"BM_Solve", "BM_Batch"}) {
        row.push_back(
            BesideCopy(ASubject(results, way + solve + "/poses:" + poses, subjects), copy));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table Shipped(const MicroResults& results) {
  report::Table table{"The default rig with poses of its recording: ns per subject and frame",
                      {"subjects", "one by one", "batch", "batch / one by one"},
                      {}};
  for (const int subjects : {1, 16, 100}) {
    const double single = ASubject(results, "BM_SolveShippedRig", subjects);
    const double batch = ASubject(results, "BM_BatchShippedRig", subjects);
    table.rows.push_back({std::to_string(subjects), Fixed(single, 0), Fixed(batch, 0),
                          Fixed(batch / single, 2) + "x"});
  }
  return table;
}

std::vector<Aim> Aims(const MicroResults& results) {
  const double batch = ASubject(results, "BM_BatchProjection/poses:2", 100);
  const double copy = ASubject(results, "BM_CopyPoses", 100);
  const double many = ASubject(results, "BM_BatchProjection/poses:2", 10000) /
                      ASubject(results, "BM_CopyPoses", 10000);
  return {{"60 drivers of 2 poses, 100 subjects", "", Fixed(batch, 0) + " ns", "", "<= 150 ns",
           batch <= 150.0},
          {"the same", "copy the poses " + Fixed(copy, 0) + " ns", Fixed(batch / copy, 1) + "x", "",
           "<= 4x", batch / copy <= 4.0},
          {"the same, 10,000 subjects", "copy the poses", Fixed(many, 1) + "x", "", "<= 4x",
           many <= 4.0}};
}

}  // namespace

std::string SolverTables(const MicroResults& results) {
  return ToMarkdown(Aims(results), "", "The solver") + "\n" +
         report::ToMarkdown(Synthetic(results, "Projection", "`projection`")) + "\n" +
         report::ToMarkdown(Synthetic(results, "Nnls", "`nnls`")) + "\n" +
         report::ToMarkdown(Shipped(results));
}

}  // namespace furrow::bench
