// Seeks the point of the unit cube at which a score is least, a generation of points at a time: CMA-ES (Hansen and
// Ostermeier, 2001), which learns from the best points of each generation where and along which directions to look
// next. It asks for no gradient, bears noise, and its generations can be evaluated side by side.
//
// The library's algorithm (pagmo) calls for one score at a time. Its points depend on the seed and on the scores of
// earlier generations alone, so it is run anew from its beginning for each generation: known scores are answered from
// memory, the rest is noted until a generation is full. This also makes it resume from nothing but the scores.
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

  // The points whose scores are wanted next: first the start alone, then generations; none when all are done.
  std::vector<Point> ask() const;
  // Their scores, in their order. Throws std::invalid_argument when they are not as many.
  void tell(const std::vector<double>& scores);

  const Point& best() const noexcept { return best_; }
  double best_score() const noexcept { return best_score_; }
  std::size_t generation() const noexcept { return generation_; }  // that ask() gives

 private:
  Config config_;
  std::vector<double> scores_;  // of all generations, the start's first
  std::size_t generation_ = 0;
  Point best_;
  double best_score_ = 0;
};

}  // namespace kadans
