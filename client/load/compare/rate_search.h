// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::load {

// Searches the highest rate that a server sustains: doubles the rate until it fails, then bisects
// the interval on a logarithmic scale until its ratio is at most `precision`. A rate counts as
// failed after `tries` failures, because a single failure may be a hiccup of the machine.
//
//   RateSearch search(1000, 400000, 1.05, 2);
//   while (!search.done()) search.Report(IsSustained(search.rate()));
//   search.best();
//
// No clock and no sockets.
class RateSearch {
 public:
  // `start` > 0, `limit` >= start, `precision` > 1, `tries` >= 1.
  RateSearch(double start, double limit, double precision, int tries)
      : rate_(start), limit_(limit), precision_(precision), tries_(tries) {}

  [[nodiscard]] bool done() const { return done_; }
  // The rate to try next, in the unit of the constructor's arguments. Valid unless done().
  [[nodiscard]] double rate() const { return rate_; }
  // The highest rate sustained so far; 0 for none.
  [[nodiscard]] double best() const { return best_; }

  // Reports the outcome of a run at rate().
  void Report(bool sustained);

 private:
  void Next();

  double rate_;
  double limit_;
  double precision_;
  int tries_;
  int failures_ = 0;    // at rate_
  double best_ = 0.0;   // highest sustained rate
  double worst_ = 0.0;  // lowest failed rate; 0: none yet
  bool done_ = false;
};

}  // namespace furrow::load
