// Searches the unit cube for the point with the least score, one generation of points at a time: CMA-ES (Hansen and
// Ostermeier, 2001). The algorithm learns from the best points of each generation where and in which directions to
// search next. It needs no gradient and tolerates noise, and the points of a generation can be evaluated in parallel.
//
// The library (pagmo) asks for one score at a time. Its points depend only on the seed and on the scores of earlier
// generations. So it is run again from the beginning for each generation: known scores are answered from memory, and
// the points whose scores are unknown are collected until a generation is full. For the same reason the scores alone
// suffice to resume a search.
#pragma once

#include <cstdint>
#include <vector>

namespace kadans {

using Point = std::vector<double>;  // numbers of 0..1

class CmaEs {
 public:
  struct Config {
    Point start;
    std::uint32_t population = 8;  // at least 5
    std::uint32_t generations = 20;
    double step = 0.25;  // first standard deviation
    std::uint64_t seed = 1;
  };
  // Throws std::invalid_argument.
  explicit CmaEs(Config config);

  // The points whose scores are needed next: first the start alone, then one generation at a time; empty when all
  // generations are done.
  std::vector<Point> ask() const;
  // The scores of the points that ask() returned, in the same order. Throws std::invalid_argument for another number of
  // scores.
  void tell(const std::vector<double>& scores);

  const Point& best() const noexcept { return best_; }
  double best_score() const noexcept { return best_score_; }
  std::size_t generation() const noexcept { return generation_; }  // of the points that ask() returns

 private:
  Config config_;
  std::vector<double> scores_;  // of all generations, the start's first
  std::size_t generation_ = 0;
  Point best_;
  double best_score_ = 0;
};

}  // namespace kadans
