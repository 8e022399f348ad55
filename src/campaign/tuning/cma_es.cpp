#include "cma_es.h"

#include <stdexcept>

#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

namespace kadans {
namespace {

// Thrown through the algorithm when the next generation is known.
struct GenerationFull {};

// Answers what is known, notes what is not.
struct Replay {
  std::vector<double> known;
  std::size_t population = 0;
  std::size_t answered = 0;
  std::vector<Point> asked{};

  double answer(const Point& point) {
    if (answered < known.size()) return known[answered++];
    asked.push_back(point);
    if (asked.size() == population) throw GenerationFull();
    return 0;
  }
};

// The score as pagmo wants it; a copy shares the replay.
struct Score {
  Replay* replay = nullptr;
  std::size_t dimensions = 1;

  pagmo::vector_double fitness(const pagmo::vector_double& point) const { return {replay->answer(point)}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(dimensions, 0.0), pagmo::vector_double(dimensions, 1.0)};
  }
};

}  // namespace

CmaEs::CmaEs(Config config) : config_(std::move(config)), best_(config_.start) {
  if (config_.start.empty()) throw std::invalid_argument("CMA-ES needs at least one dimension");
  if (config_.population < 5) throw std::invalid_argument("CMA-ES needs a population of at least 5");
}

std::vector<Point> CmaEs::ask() const {
  if (generation_ == 0) return {config_.start};
  if (generation_ > config_.generations) return {};
  Replay replay{.known = {scores_.begin() + 1, scores_.end()}, .population = config_.population};
  const auto seed = static_cast<unsigned>(config_.seed ^ config_.seed >> 32U);
  pagmo::population population(pagmo::problem(Score{&replay, config_.start.size()}), 0, seed);
  for (std::uint32_t i = 0; i < config_.population; ++i) population.push_back(config_.start, {scores_.front()});
  const pagmo::cmaes algorithm(config_.generations, -1, -1, -1, -1, config_.step, 0, 0, false, true, seed);
  try {
    (void)algorithm.evolve(population);
  } catch (const GenerationFull&) {
  }
  return replay.asked;
}

void CmaEs::tell(const std::vector<double>& scores) {
  const std::vector<Point> points = ask();
  if (scores.size() != points.size()) throw std::invalid_argument("CMA-ES needs a score for each point it asked for");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (scores_.empty() || scores[i] < best_score_) {
      best_ = points[i];
      best_score_ = scores[i];
    }
    scores_.push_back(scores[i]);
  }
  ++generation_;
}

}  // namespace kadans
