// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::load {

// Finds the highest rate that a server holds: doubles until one is not held, then halves the gap
// (by ratio) until it is at most `precision`. A rate that is not held is tried again, `tries` times
// in all, since one hiccup of the machine says nothing about the server.
//
//   RateSearch search(1000, 400000, 1.05, 2);
//   while (!search.done()) search.Tried(Holds(search.rate()));
//   search.best();
//
// Pure: no clock, no sockets.
class RateSearch {
 public:
  // `start` > 0, `limit` >= start, `precision` > 1, `tries` >= 1.
  RateSearch(double start, double limit, double precision, int tries)
      : rate_(start), limit_(limit), precision_(precision), tries_(tries) {}

  [[nodiscard]] bool done() const { return done_; }
  // What to try next.
  [[nodiscard]] double rate() const { return rate_; }
  // The highest rate that was held; 0 for none.
  [[nodiscard]] double best() const { return best_; }

  void Tried(bool held);

 private:
  void Next();

  double rate_;
  double limit_;
  double precision_;
  int tries_;
  int failures_ = 0;    // at this rate
  double best_ = 0.0;   // held
  double worst_ = 0.0;  // lowest not held; 0: none yet
  bool done_ = false;
};

}  // namespace furrow::load
